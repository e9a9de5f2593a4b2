// SPDX-License-Identifier: MIT
#include "jets/expressions/tape.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "jets/simd/pack_math.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"

namespace delf::expressions {

namespace {

using O = Operation;

constexpr int most_packs = 64;  ///< in a block: a dozen rows of them stay in the first level of the cache

}  // namespace

/// Decides from the last node to the first what is one instruction, then writes instructions from the first to the last and
/// gives rows to their results.
class Tape::Compiler {
 public:
  Compiler(const Graph& graph, const std::vector<int>& outputs, Tape& tape)
      : graph_(graph), outputs_(outputs), tape_(tape), uses_(at(graph.size()), 0), is_output_(at(graph.size()), false) {
    const std::vector<bool> reachable = graph.reachable(outputs);
    for (int i = 0; i < graph.size(); ++i)
      if (reachable[i]) for_operands(graph[i], [&](int u) { ++uses_[u]; });
    for (const int o : outputs) is_output_[o] = true;
  }

  void compile() {
    std::vector<bool> wanted(graph_.size(), false);
    std::vector<Instruction> made(graph_.size());
    std::vector<int> last_use(graph_.size(), -1);
    for (const int o : outputs_) wanted[o] = true;
    for (int i = graph_.size() - 1; i >= 0; --i) {
      if (!wanted[i] || graph_[i].operation == O::variable) continue;
      made[i] = instruction(i);
      for_rows(made[i], [&](int& u) {
        wanted[u] = true;
        last_use[u] = std::max(last_use[u], i);
      });
    }

    const int first_output = tape_.variables_, first_temporary = first_output + tape_.outputs_;
    std::vector<int> row(graph_.size(), -1), free;
    for (std::size_t o = 0; o < outputs_.size(); ++o)
      if (int& r = row[outputs_[o]]; r < 0) r = first_output + static_cast<int>(o);
    for (int i = 0; i < graph_.size(); ++i) {
      if (!wanted[i]) continue;
      if (graph_[i].operation == O::variable) {
        row[i] = graph_[i].a;
        tape_.reads_t_ = tape_.reads_t_ || graph_[i].a == tape_.variables_ - 1;
        continue;
      }
      Instruction now = made[i];
      if (row[i] < 0) {  // before the operands' rows are free again: results overwrite none of them
        if (free.empty()) free.push_back(first_temporary + tape_.temporaries_++);
        row[i] = free.back();
        free.pop_back();
      }
      std::vector<int> read;
      for_rows(now, [&](int& u) {
        if (last_use[u] == i && std::ranges::find(read, u) == read.end()) read.push_back(u);
        u = row[u];
      });
      for (const int u : read)
        if (row[u] >= first_temporary) free.push_back(row[u]);
      now.to = row[i];
      tape_.instructions_.push_back(now);
    }
    // what stands for several outputs, or is a variable
    for (std::size_t o = 0; o < outputs_.size(); ++o)
      if (const int to = first_output + static_cast<int>(o); row[outputs_[o]] != to)
        tape_.instructions_.push_back({.code = Code::affine, .to = to, .a = row[outputs_[o]]});
  }

 private:
  template <class Function>
  static void for_operands(const Node& n, const Function& f) {
    if (n.operation == O::constant || n.operation == O::variable) return;
    f(n.a);
    if (has_two_operands(n.operation)) f(n.b);
  }
  template <class Function>
  static void for_rows(Instruction& i, const Function& f) {
    if (i.code == Code::fill) return;
    f(i.a);
    const bool second = i.code == Code::add || i.code == Code::subtract || i.code == Code::scaled_add ||
                        i.code == Code::scaled_less || i.code == Code::multiply || i.code == Code::divide;
    const bool third = i.code == Code::product_add || i.code == Code::product_less || i.code == Code::less_product;
    if (second || third || i.code == Code::product_shift) f(i.b);
    if (third) f(i.c);
  }

  /// Nothing else reads it, so that it may be part of the instruction of what does.
  bool may_be_fused(int u) const { return uses_[u] == 1 && !is_output_[u]; }
  bool is_product(int u) const {
    return may_be_fused(u) && graph_[u].operation == O::multiply && !graph_.is_constant(graph_[u].a);
  }
  struct Scaled {
    double by;
    int node;
  };
  /// u = by · node
  Scaled scaled(int u) const {
    const Node& n = graph_[u];
    if (may_be_fused(u) && n.operation == O::negate) return {-1, n.a};
    if (may_be_fused(u) && n.operation == O::multiply && graph_.is_constant(n.a)) return {graph_[n.a].value, n.b};
    return {1, u};
  }
  /// k u
  Instruction times(double k, int u) const {
    const Node& n = graph_[u];
    if (is_product(u)) return {.code = Code::multiply, .a = n.a, .b = n.b, .k = k};
    if (may_be_fused(u) && is_function(n.operation)) return of_function(k, n);
    return {.code = Code::affine, .a = u, .k = k};
  }
  Instruction of_function(double k, const Node& n) const {
    const auto [l, u] = scaled(n.a);
    return {.code = Code::function, .function = n.operation, .a = u, .k = k, .l = l};
  }

  /// Instruction i with nodes in place of rows.
  Instruction instruction(int i) const {
    const Node& n = graph_[i];
    const auto value = [this](int u) { return graph_[u].value; };
    const auto product = [this](Code code, int of, int other) {
      return Instruction{.code = code, .a = graph_[of].a, .b = graph_[of].b, .c = other};
    };
    switch (n.operation) {
      case O::constant:
        return {.code = Code::fill, .k = n.value};
      case O::add: {
        if (graph_.is_constant(n.a)) {
          if (is_product(n.b))
            return {.code = Code::product_shift, .a = graph_[n.b].a, .b = graph_[n.b].b, .l = value(n.a)};
          const auto [k, u] = scaled(n.b);
          return {.code = Code::affine, .a = u, .k = k, .l = value(n.a)};
        }
        if (is_product(n.a)) return product(Code::product_add, n.a, n.b);
        if (is_product(n.b)) return product(Code::product_add, n.b, n.a);
        if (const auto [k, u] = scaled(n.a); k != 1) return {.code = Code::scaled_add, .a = u, .b = n.b, .k = k};
        if (const auto [k, u] = scaled(n.b); k != 1) return {.code = Code::scaled_add, .a = u, .b = n.a, .k = k};
        return {.code = Code::add, .a = n.a, .b = n.b};
      }
      case O::subtract: {
        if (graph_.is_constant(n.a)) {
          const auto [k, u] = scaled(n.b);
          return {.code = Code::affine, .a = u, .k = -k, .l = value(n.a)};
        }
        if (is_product(n.a)) return product(Code::product_less, n.a, n.b);
        if (is_product(n.b)) return product(Code::less_product, n.b, n.a);
        if (const auto [k, u] = scaled(n.b); k != 1) return {.code = Code::scaled_add, .a = u, .b = n.a, .k = -k};
        if (const auto [k, u] = scaled(n.a); k != 1) return {.code = Code::scaled_less, .a = u, .b = n.b, .k = k};
        return {.code = Code::subtract, .a = n.a, .b = n.b};
      }
      case O::negate:
        return times(-1, n.a);
      case O::multiply:
        if (graph_.is_constant(n.a)) return times(value(n.a), n.b);
        return {.code = Code::multiply, .a = n.a, .b = n.b};
      case O::divide:
        if (graph_.is_constant(n.a)) return {.code = Code::reciprocal, .a = n.b, .k = value(n.a)};
        if (graph_.is_constant(n.b)) return {.code = Code::affine, .a = n.a, .k = 1 / value(n.b)};
        return {.code = Code::divide, .a = n.a, .b = n.b};
      case O::power:
        return {.code = Code::power, .a = n.a, .k = n.value};
      default:
        return of_function(1, n);
    }
  }

  const Graph& graph_;
  const std::vector<int>& outputs_;
  Tape& tape_;
  std::vector<int> uses_;
  std::vector<bool> is_output_;
};

Tape::Tape(const Graph& graph, const std::vector<int>& outputs, int variables)
    : variables_(variables), outputs_(static_cast<int>(outputs.size())) {
  Compiler(graph, outputs, *this).compile();
}

namespace {

/// to[v] = f(v) for all packs of a block.
template <class Function>
[[gnu::always_inline]] inline void for_packs(double* __restrict to, int packs, const Function& f) {
  for (int v = 0; v < packs * lanes; v += lanes) f(v).store(to + v);
}

/// to = k f(l a). Flattened: a function that is not inlined into its loop spills what the loop holds in registers.
template <class Function>
[[gnu::__flatten__]] void map(double* __restrict to, const double* __restrict a, double k, double l, int packs,
                              Function f) {
  if (l == 1) for_packs(to, packs, [&](int v) { return k * f(Pack::load(a + v)); });
  else for_packs(to, packs, [&](int v) { return k * f(l * Pack::load(a + v)); });
}

void map_function(O function, double* to, const double* a, double k, double l, int packs) {
  const auto each = [&](auto f) { map(to, a, k, l, packs, f); };
  switch (function) {
    case O::sin:
      return each([](Pack x) { return sin(x); });
    case O::cos:
      return each([](Pack x) { return cos(x); });
    case O::cosm1:
      return each([](Pack x) { return cosm1(x); });
    case O::tan:
      return each([](Pack x) { return tan(x); });
    case O::exp:
      return each([](Pack x) { return exp(x); });
    case O::log:
      return each([](Pack x) { return log(x); });
    case O::sqrt:
      return each([](Pack x) { return sqrt(x); });
    case O::sinh:
      return each([](Pack x) { return sinh(x); });
    case O::cosh:
      return each([](Pack x) { return cosh(x); });
    case O::tanh:
      return each([](Pack x) { return tanh(x); });
    case O::atan:
      return each([](Pack x) { return atan(x); });
    default:
      throw std::logic_error("delf: no function of one operand");
  }
}

}  // namespace

void Tape::carry_out(const Instruction& i, double* const* rows, int packs) {
  double* const to = rows[i.to];
  const double* const pa = rows[i.a];
  const double* const pb = rows[i.b];
  const double* const pc = rows[i.c];
  const auto a = [pa](int v) { return Pack::load(pa + v); };
  const auto b = [pb](int v) { return Pack::load(pb + v); };
  const auto c = [pc](int v) { return Pack::load(pc + v); };
  const Pack k(i.k), l(i.l);
  switch (i.code) {
    case Code::fill:
      return for_packs(to, packs, [&](int) { return k; });
    case Code::affine:
      return for_packs(to, packs, [&](int v) { return k * a(v) + l; });
    case Code::add:
      return for_packs(to, packs, [&](int v) { return a(v) + b(v); });
    case Code::subtract:
      return for_packs(to, packs, [&](int v) { return a(v) - b(v); });
    case Code::scaled_add:
      return for_packs(to, packs, [&](int v) { return k * a(v) + b(v); });
    case Code::scaled_less:
      return for_packs(to, packs, [&](int v) { return k * a(v) - b(v); });
    case Code::multiply:
      return for_packs(to, packs, [&](int v) { return (k * a(v)) * b(v); });
    case Code::product_add:
      return for_packs(to, packs, [&](int v) { return a(v) * b(v) + c(v); });
    case Code::product_less:
      return for_packs(to, packs, [&](int v) { return a(v) * b(v) - c(v); });
    case Code::less_product:
      return for_packs(to, packs, [&](int v) { return c(v) - a(v) * b(v); });
    case Code::product_shift:
      return for_packs(to, packs, [&](int v) { return a(v) * b(v) + l; });
    case Code::divide:
      return for_packs(to, packs, [&](int v) { return a(v) / b(v); });
    case Code::reciprocal:
      return for_packs(to, packs, [&](int v) { return k / a(v); });
    case Code::power:
      return for_packs(to, packs, [&](int v) { return pow(a(v), i.k); });
    case Code::function:
      return map_function(i.function, to, pa, i.k, i.l, packs);
  }
}

void Tape::run(int count, const double* const* in, double t, double* const* out) const {
  const int block = std::min(count, most_packs * lanes), rows = variables_ + outputs_ + temporaries_;
  const ScratchRows temporaries(temporaries_ + 1, block);  // and one for t
  std::array<double*, 128> few;
  std::vector<double*> many;
  double** row = few.data();
  if (at(rows) > few.size()) many.resize(rows), row = many.data();
  for (int r = 0; r < temporaries_; ++r) row[variables_ + outputs_ + r] = temporaries[r + 1];
  if (reads_t_) std::fill_n(temporaries[0], block, t);
  for (int first = 0; first < count; first += block) {
    // what is read is not written: constants are taken off for the sake of one table of rows
    for (int v = 0; v < variables_ - 1; ++v) row[v] = in[v] ? const_cast<double*>(in[v]) + first : nullptr;
    row[variables_ - 1] = temporaries[0];
    for (int o = 0; o < outputs_; ++o) row[variables_ + o] = out[o] + first;
    const int packs = std::min(block, count - first) / lanes;
    for (const Instruction& i : instructions_) carry_out(i, row, packs);
  }
}

}  // namespace delf::expressions
