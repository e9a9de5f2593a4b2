// SPDX-License-Identifier: MIT
#include "schemes/states/momenta.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "lattice/error.hpp"
#include "lattice/text_parts.hpp"

namespace delf::initial {

std::vector<double> numbers(const StateBuild& build, const std::string& key, int count) {
  const auto given = build.values.maybe<std::string>(key);
  std::vector<double> list;
  if (!given) return std::vector<double>(count, 0.0);
  const auto refuse = [&](const std::string& why) { throw BadInput(key, key + " = " + *given + ": " + why); };
  for (const std::string& word : parts_of(*given)) {
    double x = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(x))
      refuse("is not a list of finite numbers; write one like 0.25, -1e-3");
    list.push_back(x);
  }
  if (static_cast<int>(list.size()) != count)
    refuse("the theory " + build.request.theory + " has " + std::to_string(count) +
           (count == 1 ? " field" : " fields") + "; give as many numbers");
  return list;
}

std::vector<double> velocities_of_momenta(const StateBuild& build, const std::vector<double>& q,
                                          const std::string& rates) {
  const std::vector<double> p = numbers(build, "initial.p", static_cast<int>(q.size()));
  const auto velocity = build.request.velocity_of ? build.request.velocity_of(q, p) : std::nullopt;
  if (!velocity) throw BadInput("initial.p", "initial.p: no velocities have these momenta at the start; give " + rates);
  return *velocity;
}

}  // namespace delf::initial
