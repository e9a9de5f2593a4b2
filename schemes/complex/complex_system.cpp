// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// Where a point lies, as weights of its vertices.
std::vector<TablePoint::Entry> place_of(const TablePoint& point) {
  if (!point[JetSlot::phi].empty()) return point[JetSlot::phi];
  std::set<int> vertices;
  for (const auto& slot : point.slots)
    for (const auto& [vertex, weight] : slot) vertices.insert(vertex);
  std::vector<TablePoint::Entry> mean;
  for (const int vertex : vertices) mean.push_back({vertex, 1 / static_cast<double>(vertices.size())});
  return mean;
}

}  // namespace

ComplexSystem::Family::Family(std::shared_ptr<const BatchDensity> density, int vertices,
                              const std::vector<TablePoint>& form)
    : density_(std::move(density)), vertices_(vertices), form_(form) {
  const int d = density_->components();
  StencilTable table{.pattern = {}, .points = {}};
  for (int l = 0; l < vertices; ++l) table.pattern.vertices.push_back({.time = 0, .space = l});
  coupled_.assign(at(vertices * d) * at(vertices * d), 0), varying_ = coupled_;
  // The numbers of a stencil are those of its table, point after point, and the place and the time of each point.
  int numbers = 0;
  for (const TablePoint& given : form) {
    TablePoint point{.slots = {}};
    point.own = {.weight = numbers++, .slots = {}};
    for (std::size_t slot = 0; slot < at(density_->slots()); ++slot)
      for (const TablePoint::Entry& e : given.slots[slot]) {
        point.slots[slot].push_back({e.vertex, 1.0}), point.own.slots[slot].push_back(numbers++);
        for (int a = 0; a < d && is_placed(); ++a)
          reads_time_ = reads_time_ || !density_->is_zero(static_cast<int>(slot) * d + a, density_->variables());
      }
    table.points.push_back(std::move(point));
    places_.push_back(place_of(given));
  }
  for (TablePoint& point : table.points)
    if (is_placed()) point.own.place = numbers++, point.own.time = numbers++;
  for (const TablePoint& point : table.points)
    for (std::size_t s = 0; s < point.slots.size(); ++s)
      for (std::size_t r = 0; r < point.slots.size(); ++r)
        for (const auto& [l, left] : point.slots[s])
          for (const auto& [m, right] : point.slots[r])
            for (int a = 0; a < d; ++a)
              for (int b = 0; b < d; ++b) {
                const int i = static_cast<int>(s) * d + a, j = static_cast<int>(r) * d + b;
                if (density_->is_zero(i, j)) continue;
                const std::size_t entry = at((l * d + a) * vertices * d + m * d + b);
                coupled_[entry] = 1;
                if (density_->is_constant(i, j)) continue;
                varying_[entry] = 1;
                linear_ = false;
              }
  linear_ = linear_ && !reads_time_;
  OwnWeights own{std::make_shared<ListedStencils>(vertices, std::vector<std::int32_t>(), 0), {}};
  own.numbers.resize(numbers);
  family_ = jets_ = std::make_shared<JetFamily>(std::move(table), density_, false, std::move(own));
}

ComplexSystem::Family::Family(std::shared_ptr<const StencilFamily> family)
    : vertices_(family->pattern().size()),
      family_(std::move(family)),
      linear_(false),
      reads_time_(family_->is_placed()) {
  coupled_.assign(at(size()) * at(size()), 1), varying_ = coupled_;
}

ComplexShape ComplexSystem::Family::shape(int values_of_site) const {
  const int sites = size() / values_of_site;
  ComplexShape shape{sites, std::vector<char>(sites * sites, 0)};
  for (int i = 0; i < size(); ++i)
    for (int m = 0; m < size(); ++m)
      if (coupled_[i * size() + m] != 0) shape.couples[i / values_of_site * sites + m / values_of_site] = 1;
  return shape;
}

int ComplexSystem::Family::add_table(std::span<const TablePoint> points) {
  bool same = points.size() == form_.size();
  std::vector<double> numbers;
  for (std::size_t q = 0; same && q < points.size(); ++q) {
    numbers.push_back(points[q].weight);
    for (std::size_t slot = 0; slot < at(density_->slots()); ++slot) {
      const auto &given = points[q].slots[slot], &form = form_[q].slots[slot];
      same = same && std::ranges::equal(given, form, {}, &TablePoint::Entry::vertex, &TablePoint::Entry::vertex);
      for (const TablePoint::Entry& e : given) numbers.push_back(e.weight);
    }
  }
  if (!same)
    throw BadInput("lattice.mesh", "a table of another form than the first of its family; make it one more family");
  if (!is_placed()) return jets_->add_own(numbers);
  tables_.push_back(std::move(numbers));
  return static_cast<int>(tables_.size()) - 1;
}

int ComplexSystem::Family::add_numbers(int table, std::span<const Complex::Position> vertices) {
  if (!jets_ || !is_placed()) return table;
  std::vector<double> numbers = tables_[table];
  for (const auto& weights : places_)
    for (const std::size_t coordinate : {1U, 0U}) {
      double place = 0;
      for (const auto& [vertex, weight] : weights) place += weight * vertices[vertex][coordinate];
      numbers.push_back(place);
    }
  return jets_->add_own(numbers);
}

int ComplexSystem::add_family(Family family) {
  complex_.add_shape(family.shape(components_));
  families_.push_back(std::move(family));
  return static_cast<int>(families_.size()) - 1;
}

int ComplexSystem::add_stencil(int family, std::span<const int> sites, int table, double measure, double time_step) {
  Family& of = families_[family];
  std::vector<Complex::Position> positions;
  const std::size_t per_vertex = sites.size() / at(of.vertices_);
  for (std::size_t l = 0; of.is_placed() && l < sites.size(); l += per_vertex)
    positions.push_back(complex_.position(sites[l]));
  numbers_.push_back(of.add_numbers(table, positions));
  measures_.push_back(measure);
  time_steps_.push_back(time_step);
  return complex_.add_stencil(family, sites);
}

std::size_t ComplexSystem::bytes() const {
  std::size_t sum = at(complex_.sites()) * 33;
  for (int s = 0; s < complex_.stencils(); ++s) sum += 36 + 4 * complex_.vertices(s).size();
  return sum;
}

std::vector<std::int32_t> ComplexSystem::all_stencils() const {
  std::vector<std::int32_t> all(complex_.stencils());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

template <class Evaluate>
void ComplexSystem::each(Stencils stencils, std::span<const double> y, int power, const Evaluate& evaluate,
                         const Visit& visit, const StencilReading& reading) const {
  std::size_t begin = 0;  // of a stencil, in places
  std::array<int, most> numbers;
  const ScratchRows x(1, most);
  std::fill_n(x[0], most, 0.0);  // points have places of their own
  for (std::size_t first = 0; first < stencils.size();) {
    const int shape = complex_.shape_number(stencils[first]);
    const Family& of = family(shape);
    const std::size_t size = of.size();
    // A batch has one time step, and one time.
    const double step = time_steps_[stencils[first]];
    std::size_t end = first + 1;
    while (end < stencils.size() && end - first < most && complex_.shape_number(stencils[end]) == shape &&
           time_steps_[stencils[end]] == step && !of.reads_time())
      ++end;
    const Stencils batch = stencils.subspan(first, end - first);
    const std::size_t count = (batch.size() + lanes - 1) / lanes * lanes, rows = power == 0   ? 1
                                                                                 : power == 1 ? size
                                                                                              : size * size;
    const ScratchRows values(of.size(), static_cast<int>(count)),
        results(static_cast<int>(rows), static_cast<int>(count)), out(static_cast<int>(rows), most);
    for (std::size_t s = 0; s < count; ++s) {  // the last one fills whole packs
      const std::size_t n = std::min(s, batch.size() - 1);
      numbers[s] = numbers_[batch[n]];
      for (std::size_t i = 0; i < size; ++i)
        values[static_cast<int>(i)][s] =
            y[reading.places.empty() ? node(batch[n], static_cast<int>(i)) : at(reading.places[begin + n * size + i])];
    }
    begin += batch.size() * size;
    const double first_time = of.jets_ ? 0 : complex_.position(complex_.vertices(batch[0])[0])[0];
    evaluate(of,
             StencilBatch{{step, 1, reading.time.value_or(first_time), 0},
                          static_cast<int>(count),
                          x[0],
                          values[0],
                          nullptr,
                          numbers.data()},
             results[0]);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t s = 0; s < batch.size(); ++s)  // |Δ| in place of the area h k of the table
        out[static_cast<int>(r)][s] = measures_[batch[s]] / (of.jets_ ? step : 1) * results[static_cast<int>(r)][s];
    visit(batch, out[0]);
    first = end;
  }
}

void ComplexSystem::each_lagrangian(Stencils s, std::span<const double> y, const Visit& visit,
                                    const StencilReading& reading) const {
  each(
      s, y, 0, [](const Family& of, const StencilBatch& batch, double* out) { of.family_->lagrangian(batch, out); },
      visit, reading);
}
void ComplexSystem::each_energy(Stencils s, std::span<const double> y, const Visit& visit) const {
  each(s, y, 0, [](const Family& of, const StencilBatch& batch, double* out) { of.jets_->energy(batch, out); }, visit,
       {});
}
void ComplexSystem::each_residual(Stencils s, std::span<const double> y, const Visit& visit,
                                  const StencilReading& reading) const {
  each(
      s, y, 1, [](const Family& of, const StencilBatch& batch, double* out) { of.family_->residual(batch, out); },
      visit, reading);
}
void ComplexSystem::each_jacobian(Stencils s, std::span<const double> y, const Visit& visit,
                                  const StencilReading& reading) const {
  each(
      s, y, 2,
      [](const Family& of, const StencilBatch& batch, double* out) {
        std::vector<int> all(of.size());
        std::iota(all.begin(), all.end(), 0);
        of.family_->jacobian(batch, all, all, out);
      },
      visit, reading);
}

std::vector<Balance> ComplexSystem::residual(std::span<const double> y) const {
  std::vector<Balance> E(nodes());
  each_residual(all_stencils(), y, [&](Stencils batch, const double* r) {
    const int size = family_of(batch[0]).size();
    for (std::size_t s = 0; s < batch.size(); ++s)
      for (int i = 0; i < size; ++i) E[node(batch[s], i)].add(r[at(i) * most + s]);
  });
  return E;
}

std::vector<double> ComplexSystem::sizes(std::span<const double> y) const {
  std::vector<double> size(nodes(), 0.0);
  each_jacobian(all_stencils(), y, [&](Stencils batch, const double* J) {
    const int count = family_of(batch[0]).size();
    for (std::size_t s = 0; s < batch.size(); ++s)
      for (int i = 0; i < count; ++i)
        for (int m = 0; m < count; ++m)
          size[node(batch[s], i)] += std::abs(J[at((i * count + m) * most) + s] * y[node(batch[s], m)]);
  });
  return size;
}

double scale_of_equations(const ComplexSystem& system, std::span<const Balance> E, std::span<const double> y) {
  constexpr double few = 8 * std::numeric_limits<double>::epsilon(), suspicious = 1e-3;
  const std::size_t d = system.components();
  const auto has_equation = [&](std::size_t n) { return system.complex().has_equation(static_cast<int>(n / d)); };
  double sum = 0, absolute = 0, size = 0;
  for (std::size_t n = 0; n < E.size(); ++n)
    if (has_equation(n))
      sum = larger_or_nan(std::abs(E[n].sum), sum), absolute = larger_or_nan(E[n].absolute, absolute);
  if (sum <= suspicious * absolute) return absolute;
  const std::vector<double> sizes = system.sizes(y);
  for (std::size_t n = 0; n < E.size(); ++n)
    if (has_equation(n)) size = std::max(size, sizes[n]);
  return absolute <= few * size ? size : absolute;
}

double largest_residual(const ComplexSystem& system, std::span<const double> y) {
  const std::vector<Balance> E = system.residual(y);
  const double scale = scale_of_equations(system, E, y);
  const std::size_t d = system.components();
  double sum = 0;
  for (std::size_t n = 0; n < E.size(); ++n)
    if (system.complex().has_equation(static_cast<int>(n / d))) sum = larger_or_nan(std::abs(E[n].sum), sum);
  return scale == 0 ? 0 : sum / scale;
}

}  // namespace delf
