// SPDX-License-Identifier: MIT
#include "jets/expressions/parse.hpp"

#include <algorithm>
#include <array>
#include <boost/spirit/home/x3.hpp>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/nearest_name.hpp"

namespace delf::expressions {

namespace {

namespace x3 = boost::spirit::x3;
using At = const char*;  ///< a place in the text

constexpr std::size_t most_bytes = 1 << 16;
constexpr int deepest = 200;

constexpr std::array<std::pair<std::string_view, Operation>, 11> functions{{{"sin", Operation::sin},
                                                                            {"cos", Operation::cos},
                                                                            {"cosm1", Operation::cosm1},
                                                                            {"tan", Operation::tan},
                                                                            {"exp", Operation::exp},
                                                                            {"log", Operation::log},
                                                                            {"sqrt", Operation::sqrt},
                                                                            {"sinh", Operation::sinh},
                                                                            {"cosh", Operation::cosh},
                                                                            {"tanh", Operation::tanh},
                                                                            {"atan", Operation::atan}}};
constexpr std::string_view power_function = "pow";
constexpr std::array<std::string_view, 7> not_differentiable{"abs", "sign", "min", "max", "floor", "ceil", "round"};

template <class Table>
auto find_name(const Table& table, std::string_view name) {
  return std::ranges::find_if(table, [name](const auto& entry) { return entry.first == name; });
}
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::ranges::all_of(text, [](char c) { return is_letter(c) || is_digit(c); });
}

/// Makes nodes of what the grammar finds, and says where something is wrong.
class Builder {
 public:
  Builder(Graph& graph, std::string_view text, const Names& names, const std::string& key)
      : graph_(graph), text_(text), names_(names), key_(key) {}

  Graph& graph() { return graph_; }

  /// One line: `KEY: line 2, character 7, at "* phi": what is wrong`, without the line where the text has no other.
  [[noreturn]] void refuse(At where, const std::string& wrong) const {
    constexpr std::ptrdiff_t most_shown = 40;
    const At begin = text_.data(), end = begin + text_.size();
    where = std::min(where, end);
    At line = where, line_end = std::find(where, end, '\n');
    while (line != begin && line[-1] != '\n') --line;
    const bool one_line = line == begin && line_end == end;
    const std::string number = one_line ? "" : "line " + std::to_string(std::count(begin, line, '\n') + 1) + ", ";
    const std::string character = "character " + std::to_string(where - line + 1);
    std::string place;  // the text from there on; at the end of a line the text before it
    At last = where + std::min(line_end - where, most_shown);
    while (last != line_end && (static_cast<unsigned char>(*last) & 0xC0) == 0x80) ++last;  // not within a letter
    if (where != line_end) place = ", at \"" + shown({where, last}) + "\"";
    else if (where != line) place = ", after \"" + shown({where - std::min(where - line, most_shown), where}) + "\"";
    throw BadInput(key_, key_ + ": " + number + character + place + ": " + wrong);
  }

  std::string found(At where) const {
    const At end = text_.data() + text_.size();
    where = std::min(where, end);
    if (where == end) return "the end";
    At stop = where + 1;
    if (is_letter(*where) || is_digit(*where))
      while (stop != end && stop - where < 30 && (is_letter(*stop) || is_digit(*stop))) ++stop;
    return "\"" + shown({where, stop}) + "\"";
  }

  /// A node that came out as a number must be a finite one.
  int checked(int node, At where) const {
    if (graph_.is_constant(node) && !std::isfinite(graph_[node].value))
      refuse(where, "this is not a finite number; correct it");
    return node;
  }

  int number(At first, At last) const {
    double value = 0;
    if (std::from_chars(first, last, value).ec != std::errc())
      refuse(first, "is outside the range of double precision; use a number that is in it");
    return graph_.constant(value);
  }

  int name(At first, At last) const {
    const std::string_view name(first, at(last - first));
    if (const auto let = find_name(lets_, name); let != lets_.end()) return let->second;
    if (const auto v = find_name(names_.variables, name); v != names_.variables.end())
      return graph_.variable(v->second);
    if (const auto c = find_name(names_.constants, name); c != names_.constants.end())
      return graph_.constant(c->second);
    if (name == "pi") return graph_.constant(std::numbers::pi);
    if (is_function(name)) refuse(last, "expected ( after the function " + std::string(name));
    refuse_unknown(first, name);
  }

  int call(At first, At last, const std::vector<int>& operands) const {
    const std::string_view name(first, at(last - first));
    const auto expect = [&](std::size_t count) {
      if (operands.size() != count)
        refuse(first, std::string(name) + " takes " + (count == 1 ? "one argument" : "two arguments") + ", not " +
                          std::to_string(operands.size()));
    };
    if (name == power_function) {
      expect(2);
      return checked(graph_.power(operands[0], operands[1]), first);
    }
    if (const auto f = find_name(functions, name); f != functions.end()) {
      expect(1);
      return checked(graph_.apply(f->second, operands[0]), first);
    }
    if (std::ranges::find(not_differentiable, name) != not_differentiable.end())
      refuse(first, std::string(name) +
                        " is not differentiable, and field equations are derivatives; use a smooth function" +
                        (name == "abs" ? ", such as sqrt(u^2 + 1e-6)" : ""));
    if (known(name)) refuse(first, std::string(name) + " is not a function; write * for a product");
    refuse_unknown(first, name);
  }

  int divide(int a, int b, At where) const {
    if (graph_.is_constant(b, 0)) refuse(where, "division by zero; correct it");
    return checked(graph_.divide(a, b), where);
  }

  void let(At first, At last, int node) {
    const std::string name(first, last);
    if (known(name)) refuse(first, name + " has a meaning already; choose another name");
    lets_.emplace_back(name, node);
  }

  bool known(std::string_view name) const {
    return find_name(lets_, name) != lets_.end() || find_name(names_.variables, name) != names_.variables.end() ||
           find_name(names_.constants, name) != names_.constants.end() || name == "pi" || name == "let" ||
           is_function(name);
  }

 private:
  /// Shows control characters, which would end the line or move the cursor, as question marks.
  static std::string shown(std::string_view part) {
    std::string text(part);
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
    return text;
  }
  static bool is_function(std::string_view name) {
    return name == power_function || find_name(functions, name) != functions.end();
  }
  [[noreturn]] void refuse_unknown(At where, std::string_view name) const {
    std::vector<std::string> all;
    for (const auto& entry : names_.variables) all.push_back(entry.first);
    for (const auto& entry : names_.constants) all.push_back(entry.first);
    for (const auto& entry : lets_) all.push_back(entry.first);
    const std::size_t listed = all.size();
    for (const auto& entry : functions) all.emplace_back(entry.first);
    for (const std::string_view more : {power_function, std::string_view("pi")}) all.emplace_back(more);
    if (const auto near = nearest(name, all))
      refuse(where, "unknown name " + std::string(name.substr(0, 60)) + "; did you mean " + *near + "?");
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(listed, 20); ++i) list += (i ? ", " : "") + all[i];
    refuse(where, "unknown name " + std::string(name.substr(0, 60)) +
                      (list.empty() ? "; use numbers and pi" : "; known: " + list));
  }

  Graph& graph_;
  std::string_view text_;
  const Names& names_;
  const std::string& key_;
  std::vector<std::pair<std::string, int>> lets_;
};

// ---- The grammar. Chains of operators and signs are loops; only brackets recurse, and those are counted beforehand.

struct InBuilder;
template <class Context>
Builder& builder(const Context& context) {
  return x3::get<InBuilder>(context).get();
}
template <class Context>
At place(const Context& context) {
  return x3::_where(context).begin();
}

const x3::rule<struct Sum, int> sum = "sum";
const x3::rule<struct Product, int> product = "product";
const x3::rule<struct Signed, int> with_sign = "signed";
const x3::rule<struct Power, int> power = "power";
const x3::rule<struct Primary, int> primary = "primary";
const x3::rule<struct Operands, std::vector<int>> operands = "operands";

using Text = boost::iterator_range<At>;
const x3::rule<struct NameToken, Text> name_token = "a name";
const auto name_token_def = x3::raw[x3::lexeme[x3::char_("a-zA-Z_") >> *x3::char_("a-zA-Z_0-9")]];
const auto exponent = x3::char_("eE") >> -x3::char_("+-") >> +x3::digit;
const auto number_token =
    x3::raw[x3::lexeme[((+x3::digit >> -('.' >> *x3::digit)) | ('.' >> +x3::digit)) >> -exponent]];
const auto signs = *x3::char_("+-");

const auto take = [](auto& c) { x3::_val(c) = x3::_attr(c); };
const auto add = [](auto& c) { x3::_val(c) = builder(c).graph().add(x3::_val(c), x3::_attr(c)); };
const auto subtract = [](auto& c) { x3::_val(c) = builder(c).graph().subtract(x3::_val(c), x3::_attr(c)); };
const auto multiply = [](auto& c) {
  x3::_val(c) = builder(c).checked(builder(c).graph().multiply(x3::_val(c), x3::_attr(c)), place(c));
};
const auto divide = [](auto& c) { x3::_val(c) = builder(c).divide(x3::_val(c), x3::_attr(c), place(c)); };
int negated_by(Builder& builder, const auto& all_signs, int node) {
  return std::ranges::count(all_signs, '-') % 2 == 0 ? node : builder.graph().negate(node);
}
const auto apply_signs = [](auto& c) {
  x3::_val(c) = negated_by(builder(c), boost::fusion::at_c<0>(x3::_attr(c)), boost::fusion::at_c<1>(x3::_attr(c)));
};
// b ^ ±e₁ ^ ±e₂ … from the last exponent on
const auto raise = [](auto& c) {
  Builder& make = builder(c);
  const auto& exponents = boost::fusion::at_c<1>(x3::_attr(c));
  const auto base = [&](std::size_t i) {
    return i == 0 ? boost::fusion::at_c<0>(x3::_attr(c)) : boost::fusion::at_c<1>(exponents[i - 1]);
  };
  int value = base(exponents.size());
  for (std::size_t i = exponents.size(); i-- > 0;)
    value = make.checked(make.graph().power(base(i), negated_by(make, boost::fusion::at_c<0>(exponents[i]), value)),
                         place(c));
  x3::_val(c) = value;
};
const auto make_number = [](auto& c) { x3::_val(c) = builder(c).number(x3::_attr(c).begin(), x3::_attr(c).end()); };
const auto make_name = [](auto& c) { x3::_val(c) = builder(c).name(x3::_attr(c).begin(), x3::_attr(c).end()); };
const auto make_call = [](auto& c) {
  const auto& name = boost::fusion::at_c<0>(x3::_attr(c));
  x3::_val(c) = builder(c).call(name.begin(), name.end(), boost::fusion::at_c<1>(x3::_attr(c)));
};

const auto sum_def = product[take] >> *(('+' > product[add]) | ('-' > product[subtract]));
const auto product_def = with_sign[take] >> *(('*' > with_sign[multiply]) | ('/' > with_sign[divide]));
const auto with_sign_def = (signs >> power)[apply_signs];
const auto power_def = (primary >> *('^' > (signs >> primary)))[raise];
const auto operands_def = sum >> *(',' > sum);
const auto primary_def = number_token[make_number] | ((name_token >> '(') > operands > ')')[make_call] |
                         name_token[make_name] | ('(' > sum[take] > ')');
BOOST_SPIRIT_DEFINE(name_token, sum, product, with_sign, power, operands, primary)

At skip_space(At from, At end) {
  return std::find_if(from, end, [](char c) { return c != ' ' && c != '\t' && c != '\r' && c != '\n'; });
}

/// A sum that fills first … last.
int parse_sum(Builder& make, At first, At last) {
  const At begin = first;
  int node = -1;
  try {
    x3::phrase_parse(
        first, last,
        x3::with<InBuilder>(std::ref(make))[x3::eps > sum[([&](auto& c) { node = x3::_attr(c); })] > x3::eoi],
        x3::space);
    return node;
  } catch (const x3::expectation_failure<At>& failure) {
    const At where = skip_space(failure.where(), last);
    const bool inside = failure.which() == "')'", at_end = failure.which().find("eoi") != std::string::npos;
    if (!inside && !at_end) {
      const bool power_of_other_languages = where != begin && where != last && *where == '*' && where[-1] == '*';
      make.refuse(where, "expected a number, a name or (, found " + make.found(where) +
                             (power_of_other_languages ? "; powers are written with ^" : ""));
    }
    make.refuse(where,
                std::string("expected an operator or ") + (inside ? ")" : "the end") + ", found " + make.found(where));
  }
}

/// Refuses texts that are too long, or nested too deep, and bytes that are no ASCII text.
void check_bounds(const Builder& make, std::string_view text, const std::string& key) {
  if (text.size() > most_bytes)
    throw BadInput(key, key + ": has " + std::to_string(text.size()) + " characters, more than " +
                            std::to_string(most_bytes) + "; shorten it");
  int depth = 0;
  for (const char& c : text) {
    if (c == '(' && ++depth > deepest)
      make.refuse(&c, "brackets are nested more than " + std::to_string(deepest) + " deep; name parts of it by let");
    if (c == ')') --depth;
    const bool white = c == '\t' || c == '\n' || c == '\r';
    if (white || (c >= ' ' && c <= '~')) continue;
    constexpr const char* digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    std::string wrong = "the byte 0x";
    wrong.append({digits[byte / 16], digits[byte % 16]});
    make.refuse(&c, wrong.append(" is no character of a formula; write names in plain letters, such as phi"));
  }
}

/// `let name = sum`, up to the end of its line or a semicolon; the place behind it.
At parse_let(Builder& make, At first, At end) {
  const At last = std::find_if(first, end, [](char c) { return c == '\n' || c == ';'; });
  At name = skip_space(first + 3, last), name_end = name;
  while (name_end != last && (is_letter(*name_end) || is_digit(*name_end))) ++name_end;
  if (!is_name({name, at(name_end - name)})) make.refuse(name, "expected a name after let");
  const At sign = skip_space(name_end, last);
  if (sign == last || *sign != '=') make.refuse(sign, "expected = after let and a name, found " + make.found(sign));
  make.let(name, name_end, parse_sum(make, sign + 1, last));
  return last;
}

}  // namespace

int parse(Graph& graph, std::string_view text, const Names& names, const std::string& key) {
  Builder make(graph, text, names, key);
  check_bounds(make, text, key);
  At from = text.data();
  const At end = from + text.size();
  try {
    for (;;) {
      from = skip_space(from, end);
      const bool is_let = end - from > 3 && std::string_view(from, 3) == "let" && (from[3] == ' ' || from[3] == '\t');
      if (!is_let) return parse_sum(make, from, end);
      from = parse_let(make, from, end);
      if (from != end) ++from;
    }
  } catch (const TooLarge& large) {
    throw BadInput(key, key + ": " + large.what() + "; simplify it");
  }
}

void check_new_name(std::string_view name, const Names& names, const std::string& key) {
  const std::string quoted = "\"" + std::string(name.substr(0, 60)) + "\"";
  if (!is_name(name))
    throw BadInput(key, key + ": " + quoted + " is no name; use letters, digits and _, a letter first");
  Graph none;
  if (Builder(none, {}, names, key).known(name))
    throw BadInput(key, key + ": " + quoted + " has a meaning already; choose another name");
}

}  // namespace delf::expressions
