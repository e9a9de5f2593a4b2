// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_system.hpp"

#include <algorithm>
#include <boost/container_hash/hash.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/complex/family_on_sites.hpp"
#include "schemes/system/listed_strips.hpp"

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

/// Marks the pairs of values of a stencil that feel each other, [i·size + m].
std::vector<char> coupled(const StencilTable& table, const BatchDensity& density, int size) {
  const int d = density.components();
  std::vector<char> all(at(size) * at(size), 0);
  for (const TablePoint& point : table.points)
    for (std::size_t s = 0; s < point.slots.size(); ++s)
      for (std::size_t r = 0; r < point.slots.size(); ++r)
        for (const auto& [l, left] : point.slots[s])
          for (const auto& [m, right] : point.slots[r])
            for (int a = 0; a < d; ++a)
              for (int b = 0; b < d; ++b)
                if (!density.is_zero(static_cast<int>(s) * d + a, static_cast<int>(r) * d + b))
                  all[at((l * d + a) * size + m * d + b)] = 1;
  return all;
}

}  // namespace

ComplexSystem::Family::Family(std::shared_ptr<const BatchDensity> density, int vertices,
                              const std::vector<TablePoint>& form)
    : density_(std::move(density)), vertices_(vertices), size_(vertices * density_->components()), form_(form) {
  const int d = density_->components();
  for (int l = 0; l < vertices; ++l) table_.pattern.vertices.push_back({.time = 0, .space = l});
  // The numbers of a stencil are those of its table, point after point, and the place and the time of each point.
  for (const TablePoint& given : form) {
    TablePoint point{.slots = {}};
    const auto number = [&](SlotPowers powers) {
      powers_.push_back(powers);
      return static_cast<int>(powers_.size()) - 1;
    };
    point.own = {.weight = number({0, 0}), .slots = {}};
    for (std::size_t slot = 0; slot < at(density_->slots()); ++slot)
      for (const TablePoint::Entry& e : given.slots[slot]) {
        point.slots[slot].push_back({e.vertex, 1.0}), point.own.slots[slot].push_back(number(slot_powers[slot]));
        for (int a = 0; a < d && is_placed(); ++a)
          reads_time_ = reads_time_ || !density_->is_zero(static_cast<int>(slot) * d + a, density_->variables());
      }
    table_.points.push_back(std::move(point));
    places_.push_back(place_of(given));
  }
  auto numbers = static_cast<int>(powers_.size());
  for (TablePoint& point : table_.points)
    if (is_placed()) point.own.place = numbers++, point.own.time = numbers++;
  coupled_ = coupled(table_, *density_, size_);
}

ComplexSystem::Family::Family(std::shared_ptr<const StencilFamily> family)
    : family_(std::move(family)),
      vertices_(family_->pattern().size()),
      size_(family_->size()),
      reads_time_(family_->is_placed()) {
  if (const DensityOnTable* of = family_->made_of()) coupled_ = coupled(of->table, *of->density, size_);
  else coupled_.assign(at(size_) * at(size_), 1);
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
  const std::size_t hash = boost::hash_value(numbers);
  const auto [begin, end] = known_.equal_range(hash);
  for (auto other = begin; other != end; ++other)
    if (std::ranges::equal(table(other->second), numbers)) return other->second;
  const auto number = static_cast<std::int32_t>(known_.size());
  known_.emplace(hash, number);
  tables_.insert(tables_.end(), numbers.begin(), numbers.end());
  return number;
}

std::vector<double> ComplexSystem::Family::places(std::span<const Complex::Position> vertices) const {
  std::vector<double> places;
  for (const auto& weights : places_)
    for (const std::size_t coordinate : {1U, 0U}) {
      double place = 0;
      for (const auto& [vertex, weight] : weights) place += weight * vertices[vertex][coordinate];
      places.push_back(place);
    }
  return places;
}

/// The tables of some stencils: measures are in the weights of points, and steps in those of derivatives in time. Stencils of
/// one table, measure and step share their numbers, unless each has its place besides.
std::shared_ptr<const JetFamily> ComplexSystem::Family::on(std::shared_ptr<const ListedStencils> sites,
                                                           const Stencils& stencils) const {
  OwnWeights own{std::move(sites), std::vector<std::vector<double>>(powers_.size())};
  std::vector<std::size_t> first;  // stencil of each set
  using Key = std::tuple<std::int32_t, double, double>;
  std::unordered_map<Key, std::int32_t, boost::hash<Key>> known;
  for (std::size_t s = 0; s < stencils.tables.size(); ++s) {
    const auto next = static_cast<std::int32_t>(first.size());
    const std::int32_t set =
        is_placed()
            ? next
            : known.try_emplace({stencils.tables[s], stencils.measures[s], stencils.steps[s]}, next).first->second;
    if (set == next) first.push_back(s);
    own.sets.push_back(set);
  }
  if (first.size() == own.sets.size()) own.sets = {};
  for (std::size_t n = 0; n < powers_.size(); ++n) {
    own.numbers[n].reserve(first.size());
    for (const std::size_t s : first) {
      double number = table(stencils.tables[s])[n];
      for (int power = powers_[n].time; power > 0; --power) number /= stencils.steps[s];
      own.numbers[n].push_back(number);
    }
  }
  for (const TablePoint& point : table_.points)
    for (std::size_t n = 0; n < first.size(); ++n) own.numbers[point.own.weight][n] *= stencils.measures[first[n]];
  for (std::size_t n = 0; is_placed() && n < 2 * form_.size(); ++n) {
    own.numbers.emplace_back();
    for (const auto& places : stencils.places) own.numbers.back().push_back(places[n]);
  }
  return std::make_shared<JetFamily>(table_, density_, false, std::move(own));
}

int ComplexSystem::add_family(Family family) {
  complex_.add_shape(family.shape(components_));
  families_.push_back(std::move(family));
  return static_cast<int>(families_.size()) - 1;
}

int ComplexSystem::add_stencil(int family, std::span<const int> sites, int table, double measure, double time_step) {
  const int number = complex_.add_stencil(family, sites);
  row_.reset();
  const Family& of = families_[family];
  std::vector<double> places, alike;  // `alike`: what stencils of one batch share
  if (of.density_ && of.is_placed()) {
    std::vector<Complex::Position> positions;
    const std::size_t per_vertex = sites.size() / at(of.vertices_);
    for (std::size_t l = 0; l < sites.size(); l += per_vertex) positions.push_back(complex_.position(sites[l]));
    places = of.places(positions);
    for (std::size_t n = 1; n < places.size() && of.reads_time_; n += 2) alike.push_back(places[n]);
  }
  const double time = complex_.position(sites[0])[0];
  if (!of.density_) alike = {time_step, of.reads_time_ ? time : 0};
  const auto [list, fresh] = list_of_.try_emplace({family, std::move(alike)}, static_cast<std::int32_t>(lists_.size()));
  if (fresh) lists_.push_back({.family = family, .step = time_step, .time = time});
  Stencils& to = lists_[list->second];
  anchors_.push_back({list->second, static_cast<std::int32_t>(to.numbers.size())});
  to.tables.push_back(table), to.numbers.push_back(number), to.measures.push_back(measure);
  to.steps.push_back(time_step);
  if (!places.empty()) to.places.push_back(std::move(places));
  return number;
}

std::shared_ptr<const StencilFamily> ComplexSystem::family_on_row(const Stencils& stencils,
                                                                  std::shared_ptr<const JetFamily>& tables) const {
  const Family& of = families_[stencils.family];
  const int sites = of.size() / components_;
  std::vector<std::int32_t> vertices;
  for (const auto stencil : stencils.numbers)
    vertices.insert(vertices.end(), complex_.vertices(stencil).begin(), complex_.vertices(stencil).end());
  auto listed = std::make_shared<ListedStencils>(sites, std::move(vertices), complex_.sites());
  if (of.density_) {
    tables = of.on(listed, stencils);
    if (components_ == of.density_->components()) return tables;
    return std::make_shared<FamilyOnSites>(tables, components_, listed, std::nullopt);
  }
  return std::make_shared<FamilyOnSites>(
      of.family_, components_, listed,
      FamilyOnSites::Moved{{stencils.step, 1, stencils.time, 0}, stencils.tables, stencils.measures});
}

const LatticeSystem& ComplexSystem::row() const {
  if (row_) return *row_;
  MeshSpace space{.mesh = {.points = {}, .vertices = {}}, .fixed = std::vector<char>(complex_.sites(), 0)};
  for (int s = 0; s < complex_.sites(); ++s) {
    const auto& [t, x, y, z] = complex_.position(s);
    space.mesh.points.push_back({x, y, z});
  }
  std::vector<std::shared_ptr<const StencilFamily>> families;
  tables_.assign(lists_.size(), nullptr);
  for (std::size_t n = 0; n < lists_.size(); ++n) families.push_back(family_on_row(lists_[n], tables_[n]));
  row_ = std::make_shared<LatticeSystem>(Lattice::on(std::make_shared<MeshSpace>(std::move(space))),
                                         std::move(families), 1.0, fields(components_));
  return *row_;
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

Assembly ComplexSystem::assembly(std::span<const std::int32_t> stencils) const {
  std::vector<Assembly::Anchor> anchors;
  for (const auto s : stencils) anchors.push_back(anchor(s));
  return {row(), {.equations = {}, .stencils = std::move(anchors)}};
}

namespace {

SectionView one_row(std::span<const double> y) { return {y.data(), 1, y.size()}; }

}  // namespace

void ComplexSystem::each_residual(std::span<const std::int32_t> stencils, std::span<const double> y,
                                  const Visit& visit) const {
  assembly(stencils).each_residual(one_row(y), 0, [&](const Assembly::Local& at) { visit(stencil(at.anchor), at); });
}

void ComplexSystem::each_jacobian(std::span<const std::int32_t> stencils, std::span<const double> y,
                                  const Visit& visit) const {
  assembly(stencils).each_jacobian(one_row(y), 0, [&](const Assembly::Local& at) { visit(stencil(at.anchor), at); });
}

std::vector<double> ComplexSystem::lagrangians(std::span<const double> y) const {
  std::vector<double> all(complex_.stencils());
  const ScratchRows L(1, 64);
  for (std::size_t list = 0; list < lists_.size(); ++list)
    each_listed_strip(*row().families()[list], y, components_, 0, [&](const StencilBatch& strip, int count) {
      row_->families()[list]->lagrangian(strip, L[0]);
      for (int s = 0; s < count; ++s) all[lists_[list].numbers[strip.numbers[s]]] = L[0][s];
    });
  return all;
}

std::vector<double> ComplexSystem::energies(std::span<const double> y) const {
  std::vector<double> all(complex_.stencils());
  const ScratchRows E(1, 64);
  for (std::size_t list = 0; list < lists_.size(); ++list)
    each_listed_strip(*row().families()[list], y, components_, 0, [&](const StencilBatch& strip, int count) {
      tables_[list]->energy(strip, E[0]);
      for (int s = 0; s < count; ++s) all[lists_[list].numbers[strip.numbers[s]]] = E[0][s];
    });
  return all;
}

std::vector<Balance> ComplexSystem::residual(std::span<const double> y) const {
  std::vector<Balance> E(nodes());
  each_residual(all_stencils(), y, [&](int, const Assembly::Local& here) {
    for (std::size_t i = 0; i < here.places.size(); ++i) E[here.places[i]].add(here.derivatives[i]);
  });
  return E;
}

std::vector<double> ComplexSystem::sizes(std::span<const double> y) const {
  std::vector<double> size(nodes(), 0.0);
  each_jacobian(all_stencils(), y, [&](int, const Assembly::Local& here) {
    const std::size_t count = here.places.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t m = 0; m < count; ++m)
        size[here.places[i]] += std::abs(here.derivatives[i * count + m] * here.y[m]);
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
