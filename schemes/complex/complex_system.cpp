// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "jets/simd/scratch_rows.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int ComplexSystem::add_family(PlacedFamily family) {
  complex_.add_shape(family.shape(components_));
  families_.push_back(std::move(family));
  return static_cast<int>(families_.size()) - 1;
}

int ComplexSystem::add_part() {
  parts_.emplace_back();
  return parts() - 1;
}

double ComplexSystem::factor(int part, int power) const {
  const auto [measure, time_step] = parts_[at(part)];
  return measure / std::pow(time_step, power);
}

int ComplexSystem::add_stencil(int family, std::span<const int> sites, int table, double measure, double time_step,
                               int part) {
  if (part != 0 && !this->family(family).time_power())
    throw std::logic_error("weights of phi_t beside others in a part of a complex");
  part_of_.push_back(part);
  tables_.push_back(table);
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
  std::vector<std::int32_t> all(at(complex_.stencils()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

template <class Evaluate>
void ComplexSystem::each(Stencils stencils, std::span<const double> y, int power, const Evaluate& evaluate,
                         const Visit& visit, const StencilReading& reading) const {
  std::size_t begin = 0;  // of a stencil, in places
  constexpr int most = PlacedFamily::most;
  std::array<std::int32_t, most> tables;
  std::array<double, most> measures, steps;
  for (std::size_t first = 0; first < stencils.size();) {
    const int shape = complex_.shape_number(stencils[first]);
    const int number = part_of(stencils[first]);
    const PlacedFamily& of = family(shape);
    const Part part = reading.unscaled ? Part{} : parts_[at(number)];
    std::size_t end = first;
    while (end < stencils.size() && end - first < most && complex_.shape_number(stencils[end]) == shape &&
           part_of(stencils[end]) == number)
      ++end;
    const Stencils batch = stencils.subspan(first, end - first);
    const ScratchRows values(of.size(), most), places(of.is_placed() ? 2 * of.vertices() : 0, most);
    const ScratchRows numbers(power == 0 ? 1 : power == 1 ? of.size() : of.size() * of.size(), most);
    for (std::size_t s = 0; s < batch.size(); ++s) {
      const auto stencil = at(batch[s]);
      tables[s] = tables_[stencil];
      measures[s] = part.measure * measures_[stencil], steps[s] = part.time_step * time_steps_[stencil];
      for (int i = 0; i < of.size(); ++i)
        values[i][s] = y[reading.places.empty() ? node(batch[s], i) : at(reading.places[begin + at(i)])];
      begin += at(of.size());
      for (int l = 0; l < of.vertices() && of.is_placed(); ++l) {
        const Complex::Position& position = complex_.position(complex_.vertices(batch[s])[at(l)]);
        places[l][s] = position[0], places[of.vertices() + l][s] = position[1];
      }
    }
    PlacedBatch placed{static_cast<int>(batch.size()), tables.data(), measures.data(), steps.data(), values[0]};
    if (of.is_placed()) placed.t = places[0], placed.x = places[of.vertices()];
    evaluate(of, placed, numbers[0]);
    visit(batch, numbers[0]);
    first = end;
  }
}

void ComplexSystem::each_lagrangian(Stencils s, std::span<const double> y, const Visit& visit) const {
  each(s, y, 0, [](const auto& family, const auto& batch, double* out) { family.lagrangian(batch, out); }, visit, {});
}
void ComplexSystem::each_energy(Stencils s, std::span<const double> y, const Visit& visit) const {
  each(s, y, 0, [](const auto& family, const auto& batch, double* out) { family.energy(batch, out); }, visit, {});
}
void ComplexSystem::each_residual(Stencils s, std::span<const double> y, const Visit& visit,
                                  const StencilReading& reading) const {
  each(
      s, y, 1, [](const auto& family, const auto& batch, double* out) { family.residual(batch, out); }, visit, reading);
}
void ComplexSystem::each_jacobian(Stencils s, std::span<const double> y, const Visit& visit,
                                  const StencilReading& reading) const {
  each(
      s, y, 2, [](const auto& family, const auto& batch, double* out) { family.jacobian(batch, out); }, visit, reading);
}

std::vector<Balance> ComplexSystem::residual(std::span<const double> y) const {
  std::vector<Balance> E(nodes());
  each_residual(all_stencils(), y, [&](Stencils batch, const double* r) {
    const int size = family_of(batch[0]).size();
    for (std::size_t s = 0; s < batch.size(); ++s)
      for (int i = 0; i < size; ++i) E[node(batch[s], i)].add(r[at(i) * PlacedFamily::most + s]);
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
          size[node(batch[s], i)] += std::abs(J[at((i * count + m) * PlacedFamily::most) + s] * y[node(batch[s], m)]);
  });
  return size;
}

double scale_of_equations(const ComplexSystem& system, std::span<const Balance> E, std::span<const double> y) {
  constexpr double few = 8 * std::numeric_limits<double>::epsilon(), suspicious = 1e-3;
  const auto d = at(system.components());
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
  const auto d = at(system.components());
  double sum = 0;
  for (std::size_t n = 0; n < E.size(); ++n)
    if (system.complex().has_equation(static_cast<int>(n / d))) sum = larger_or_nan(std::abs(E[n].sum), sum);
  return scale == 0 ? 0 : sum / scale;
}

}  // namespace delf
