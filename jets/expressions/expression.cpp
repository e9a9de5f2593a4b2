// SPDX-License-Identifier: MIT
#include "jets/expressions/expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/expressions/quotient.hpp"
#include "jets/expressions/tape.hpp"
#include "jets/field_motion.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "jets/value_derivatives.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {

namespace {

using namespace expressions;
using O = Operation;

constexpr std::array<const char*, 6> slot_endings{"", "_t", "_x", "_tt", "_tx", "_xx"};

/// Variables in a graph, whether second derivatives occur or not: six slots of d fields, then x, then t.
struct Numbering {
  int d;
  int x() const { return 6 * d; }
  int t() const { return 6 * d + 1; }
  int count() const { return 6 * d + 2; }
};

/// A field that is called x has the name of the place, which a point has not.
bool names_place(const std::vector<std::string>& fields) { return std::ranges::find(fields, "x") == fields.end(); }

Names names_of(const ExpressionNames& given) {
  const Numbering number{static_cast<int>(given.fields.size())};
  Names names{{{"t", number.t()}}, {}};
  if (names_place(given.fields)) names.variables.emplace_back("x", number.x());
  for (int a = 0; a < number.d; ++a)
    for (int s = 0; s < 6; ++s) names.variables.emplace_back(given.fields[a] + slot_endings[s], s * number.d + a);
  names.constants = given.parameters;
  return names;
}

/// The expression on abstract numbers: x and t follow the slots that occur.
Abstract abstract_value(const Graph& graph, int root, const Numbering& number, int m) {
  return Evaluation(graph, root).operator()<Abstract>([&](int variable) {
    if (variable == number.t() || variable == number.x())
      return Abstract::variable(variable == number.t() ? m : m + 1, std::nullopt);
    return Abstract::variable(variable, variable / number.d);
  });
}

class ExpressionDensity final : public SymbolicDensity, public ValueDerivatives {
 public:
  ExpressionDensity(std::string_view text, const ExpressionNames& names, const std::string& key,
                    const BesidesDensity& besides)
      : SymbolicDensity(text, names, besides), number_{static_cast<int>(names.fields.size())} {
    Graph graph;
    const int l = parse(graph, text, names_of(names), key);
    try {
      find_structure(graph, l, names, key);
      make_tapes(graph, l);
      make_quotient(graph, l);
    } catch (const TooLarge& large) {
      throw BadInput(key, key + ": " + large.what() + "; simplify it");
    }
    symmetries_.insert(symmetries_.end(), besides.symmetries.begin(), besides.symmetries.end());
    find_constants();
  }

  void value(const JetBatch& batch, double* l) const override { run(value_, batch, &l); }
  void gradient(const JetBatch& batch, double* const* g, double* l) const override {
    if (!l) return run(gradient_, batch, g);
    std::vector<double*> out(g, g + variables());
    out.push_back(l);
    run(gradient_and_value_, batch, out.data());
  }
  void hessian(const JetBatch& batch, double* const* H) const override { run(hessian_, batch, H); }
  void slope(const JetBatch& batch, double* const* g) const override { run(slope_, batch, g, components_); }
  void curvature(const JetBatch& batch, double* const* c) const override { run(curvature_, batch, c, components_); }
  void slope_and_curvature(const JetBatch& phi, double* const* g, double* const* c) const override {
    slope(phi, g);
    curvature(phi, c);
  }
  void curvature_along(const JetBatch& phi, const double* const* v, double* const* c) const override {
    const int d = components_;
    const ScratchRows third(d * d * d, phi.count);
    run(third_, phi, third.data(), d);
    for (int ab = 0; ab < d * d; ++ab)
      for (int i = 0; i < phi.count; i += lanes) {
        Pack sum(0.0);
        for (int e = 0; e < d; ++e) sum += Pack::load(third[ab * d + e] + i) * Pack::load(v[e] + i);
        sum.store(c[ab] + i);
      }
  }
  void difference_quotient(const JetBatch& ab, double* const* q) const override { quotient_.value(ab, q[0]); }
  void differentiate_quotient(const JetBatch& ab, double* const* d) const override {
    quotient_.derivatives(ab, d[0], d[1]);
  }
  const ValueDerivatives* value_derivatives() const override { return this; }
  void place_gradient(const JetBatch& batch, double* l_t, double* l_x) const override {
    const std::array<double*, 2> out{l_t, l_x};
    run(by_place_, batch, out.data());
  }

 private:
  void find_structure(const Graph& graph, int l, const ExpressionNames& names, const std::string& key) {
    const int d = number_.d;
    components_ = d;
    slots_ = 3;
    const std::vector<bool> wanted = graph.reachable({l});
    for (int i = 0; i <= l; ++i) {
      if (!wanted[i] || graph[i].operation != O::variable) continue;
      if (graph[i].a == number_.t() || graph[i].a == number_.x()) placed_ = true;
      else if (graph[i].a >= 3 * d) slots_ = 6;
    }
    const int m = variables();
    if (m + 2 > Abstract::most_variables)
      throw BadInput(key, key + ": " + std::to_string(d) + " fields with " + std::to_string(m) +
                              " values and derivatives are more than " + std::to_string(Abstract::most_variables - 2) +
                              "; use fewer fields");
    structure_ = structure_of(abstract_value(graph, l, number_, m), m, d);
    for (int a = 0; a < d; ++a) require_determined(a, names.fields[a], key);
    for (int a = 0; a < d; ++a)
      if (!depends_on(a) && constraint().empty()) {  // φᵃ ↦ φᵃ + ε
        LinearSymmetry shift{"translation" + (d > 1 ? " of " + names.fields[a] : ""), std::vector<double>(d * d, 0.0),
                             std::vector<double>(d, 0.0)};
        shift.shift[a] = 1;
        symmetries_.push_back(std::move(shift));
      }
  }

  /// A field has an equation that a step could solve for it if its rate enters a second derivative of ℓ, or if the field
  /// itself does together with the rate of another: p in p q_t.
  void require_determined(int a, const std::string& field, const std::string& key) const {
    bool present = false;
    for (int s = 0; s < slots_; ++s) present = present || depends_on(s * components_ + a);
    FieldMotion fields(components_);
    fields.add(*this);
    const auto refuse = [&](const std::string& why) {
      throw BadInput(key, key + ": does not determine the field " + field + ": " + why);
    };
    if (!present)
      refuse("neither it nor its derivatives occur; add terms such as 0.5*" + field +
             "_t^2, or remove it from the fields");
    if (!fields.moving[a])
      refuse(depends_on(components_ + a)
                 ? field + "_t occurs only linearly, with a constant factor; add a term such as 0.5*" + field + "_t^2"
                 : field + "_t does not occur; add a term such as 0.5*" + field + "_t^2");
  }

  void make_tapes(Graph& graph, int l) {
    const int m = variables(), d = components_, zero = graph.constant(0);
    std::vector<int> g, H(at(m * m), zero), slopes, curvatures, thirds;
    for (int a = 0; a < m; ++a) g.push_back(depends_on(a) ? graph.differentiate(l, a) : zero);
    for (int a = 0; a < m; ++a)
      for (int b = 0; b <= a; ++b)
        if (!is_zero(a, b)) H[a * m + b] = H[b * m + a] = graph.differentiate(g[a], b);
    const auto at_rest = [&](int root) {
      return graph.substitute(
          root, [&](int v) { return v >= d && v != number_.t() && v != number_.x() ? zero : graph.variable(v); });
    };
    for (int a = 0; a < d; ++a) slopes.push_back(at_rest(g[a]));
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) curvatures.push_back(at_rest(H[a * m + b]));
    for (const int curvature : curvatures)
      for (int e = 0; e < d; ++e) thirds.push_back(graph.differentiate(curvature, e));
    const std::vector<int> places{graph.differentiate(l, number_.t()), graph.differentiate(l, number_.x())};

    const int count = number_.count();
    value_ = Tape(graph, {l}, count);
    gradient_ = Tape(graph, g, count);
    g.push_back(l);
    gradient_and_value_ = Tape(graph, g, count);
    hessian_ = Tape(graph, H, count);
    slope_ = Tape(graph, slopes, count);
    curvature_ = Tape(graph, curvatures, count);
    third_ = Tape(graph, thirds, count);
    by_place_ = Tape(graph, places, count);
  }

  /// Comparators read the potential N(φ) = ℓ(φ, 0, 0) of one field alone.
  void make_quotient(Graph& graph, int l) {
    constexpr int longest = 3000;  // eight derivatives of longer ones would take longer than a start may
    if (components_ != 1 || slots_ != 3 || placed_ || nonlinearity() == Nonlinearity::all || graph.size() > longest)
      return;
    const int potential = graph.substitute(l, [&](int v) { return v == 0 ? graph.variable(0) : graph.constant(0); });
    try {
      quotient_ = Quotient(graph, potential, number_.count());
      has_difference_quotient_ = true;
    } catch (const TooLarge&) {  // of eight derivatives; nothing but comparators misses them
    }
  }

  void run(const Tape& tape, const JetBatch& batch, double* const* out) const { run(tape, batch, out, variables()); }
  void run(const Tape& tape, const JetBatch& batch, double* const* out, int given) const {
    std::array<const double*, 2 * Abstract::most_variables>
        in;  // a call is short: no more of it is written than is read
    std::fill(std::copy_n(batch.slots, given, in.begin()), in.begin() + number_.count(), nullptr);
    in[number_.x()] = batch.x;
    tape.run(batch.count, in.data(), batch.t, out);
  }

  Numbering number_;
  Tape value_, gradient_, gradient_and_value_, hessian_, slope_, curvature_, third_, by_place_;
  Quotient quotient_;
};

}  // namespace

void check_names(const ExpressionNames& given, const std::string& key_of_fields, const std::string& key_of_parameters) {
  if (given.fields.empty()) throw BadInput(key_of_fields, key_of_fields + ": names no field; give one, such as phi");
  constexpr std::size_t most_fields = 20;
  if (given.fields.size() > most_fields)
    throw BadInput(key_of_fields, key_of_fields + ": more than " + std::to_string(most_fields) + " fields; use fewer");
  ExpressionNames before{{}, {}};
  for (const std::string& field : given.fields) {
    Names known = names_of(before);
    if (field == "x" && names_place(before.fields))
      std::erase_if(known.variables, [](const auto& v) { return v.first == "x"; });
    for (const char* ending : slot_endings) check_new_name(field + ending, known, key_of_fields);
    before.fields.push_back(field);
  }
  for (const auto& parameter : given.parameters) {
    check_new_name(parameter.first, names_of(before), key_of_parameters);
    before.parameters.push_back(parameter);
  }
}

std::shared_ptr<const SymbolicDensity> expression(std::string_view text, const ExpressionNames& names,
                                                  const std::string& key, const BesidesDensity& besides) {
  check_names(names, key, key);
  return std::make_shared<ExpressionDensity>(text, names, key, besides);
}

struct Formula::Impl {
  Tape all;
  std::array<double, 3> operator()(double t, double x) const {
    const Pack at_x(x);
    std::array<Pack, 3> result;
    const std::array<const double*, 2> in{reinterpret_cast<const double*>(&at_x), nullptr};
    std::array<double*, 3> out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = reinterpret_cast<double*>(&result[i]);
    all.run(lanes, in.data(), t, out.data());
    return {result[0][0], result[1][0], result[2][0]};
  }
};

Formula::Formula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
                 const std::string& key) {
  Graph graph;
  const Names names{{{"x", 0}, {"t", 1}}, parameters};
  const int f = parse(graph, text, names, key);
  impl_.reset(new Impl{Tape(graph, {f, graph.differentiate(f, 1), graph.differentiate(f, 0)}, 2)});
}
Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
double Formula::operator()(double t, double x) const { return (*impl_)(t, x)[0]; }
double Formula::by_t(double t, double x) const { return (*impl_)(t, x)[1]; }
double Formula::by_x(double t, double x) const { return (*impl_)(t, x)[2]; }

double number_of(std::string_view text, const std::string& key,
                 const std::vector<std::pair<std::string, double>>& parameters) {
  Graph graph;
  return graph[parse(graph, text, {{}, parameters}, key)].value;
}

}  // namespace delf
