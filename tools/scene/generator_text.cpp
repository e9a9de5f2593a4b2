// SPDX-License-Identifier: MIT
#include "tools/scene/generator_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/text_parts.hpp"

namespace delf {

namespace {

BadInput wrong(const std::string& what) { return {"verify.generator", what}; }

std::optional<double> number(const std::string& text) {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool read = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return read ? std::optional(value) : std::nullopt;
}

// "2*phi1", "phi1" or "0.5", with its sign, into row a
void add_term(LinearSymmetry& symmetry, std::size_t a, double sign, const std::string& term,
              const std::vector<std::string>& fields) {
  if (term.empty()) throw wrong("a sign has nothing after it; write terms like 0.5, phi1 or 2*phi1");
  double factor = sign;
  std::string name;
  for (const std::string& part : parts_of(term, '*')) {
    if (const auto value = number(part)) factor *= *value;
    else if (name.empty() && !part.empty()) name = part;
    else throw wrong(fmt::format("\"{}\" is no term; write one like 0.5, phi1 or 2*phi1", term));
  }
  if (!std::isfinite(factor)) throw wrong(fmt::format("\"{}\" is too large; any multiple of it will do", term));
  if (name.empty()) {
    symmetry.shift[a] += factor;
    return;
  }
  const auto field = std::find(fields.begin(), fields.end(), name);
  if (field == fields.end())
    throw wrong(fmt::format("\"{}\" is no field of this scheme, which has {}", name, fmt::join(fields, ", ")));
  symmetry.matrix[a * fields.size() + static_cast<std::size_t>(field - fields.begin())] += factor;
}

}  // namespace

LinearSymmetry read_generator(const std::string& text, const std::vector<std::string>& fields) {
  const std::size_t d = fields.size();
  LinearSymmetry symmetry{"generator (" + text + ")", std::vector<double>(d * d, 0.0), std::vector<double>(d, 0.0)};
  const std::vector<std::string> changes = parts_of(text, ',');
  if (changes.size() != d)
    throw wrong(fmt::format("has {} part{}; give one for each of {}, separated by commas", changes.size(),
                            changes.size() == 1 ? "" : "s", fmt::join(fields, ", ")));
  for (std::size_t a = 0; a < d; ++a) {
    const std::string& sum = changes[a];
    for (std::size_t begin = 0; begin < sum.size();) {
      const double sign = sum[begin] == '-' ? -1 : 1;
      if (sum[begin] == '-' || sum[begin] == '+') ++begin;
      // A sign after an e belongs to a number: 1e-3.
      std::size_t end = begin;
      while (end < sum.size() &&
             ((sum[end] != '+' && sum[end] != '-') || (end > begin && (sum[end - 1] == 'e' || sum[end - 1] == 'E') &&
                                                       end > begin + 1 && std::isdigit(sum[end - 2]))))
        ++end;
      add_term(symmetry, a, sign, trimmed(sum.substr(begin, end - begin)), fields);
      begin = end;
    }
    if (sum.empty()) throw wrong("has an empty part; write 0 for a field that stays as it is");
  }
  const auto is_zero = [](double x) { return x == 0; };
  if (std::ranges::all_of(symmetry.shift, is_zero) && std::ranges::all_of(symmetry.matrix, is_zero))
    throw wrong("changes no field, and of that nothing follows; give a change that is not 0");
  return symmetry;
}

}  // namespace delf
