// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_form.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "lattice/index.hpp"

namespace delf {
namespace {

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

ComplexRegion::ComplexRegion(const Complex& complex, const Touching& touching, const std::vector<int>& sites)
    : sites_(sites) {
  sort_unique(sites_);
  const auto holds = [&](int site) { return std::binary_search(sites_.begin(), sites_.end(), site); };
  std::vector<int> closure;
  for (const int site : sites_) {
    bool all = complex.has_equation(site) && !touching[site].empty();
    for (const auto stencil : touching[site]) {
      const bool inside = std::ranges::all_of(complex.vertices(stencil), holds);
      all = all && inside;
      if (inside) stencils_.push_back(stencil);
    }
    if (!all) continue;
    interior_.push_back(site);
    for (const auto stencil : touching[site])
      closure.insert(closure.end(), complex.vertices(stencil).begin(), complex.vertices(stencil).end());
  }
  sort_unique(closure);
  std::set_difference(closure.begin(), closure.end(), interior_.begin(), interior_.end(),
                      std::back_inserter(boundary_));
  std::sort(stencils_.begin(), stencils_.end(), [&](auto s, auto t) {
    return std::pair(complex.shape_number(s), s) < std::pair(complex.shape_number(t), t);
  });
  stencils_.erase(std::unique(stencils_.begin(), stencils_.end()), stencils_.end());
}

ComplexRegion ComplexRegion::around(const Complex& complex, const Touching& touching, const std::vector<int>& centres) {
  std::vector<int> sites;
  for (const int centre : centres)
    for (const auto stencil : touching[centre])
      sites.insert(sites.end(), complex.vertices(stencil).begin(), complex.vertices(stencil).end());
  return {complex, touching, sites};
}

std::vector<int> draw_centres(const Complex& complex, const Touching& touching, int count, std::mt19937_64& random) {
  std::vector<int> able;
  for (int s = 0; s < complex.sites(); ++s)
    if (complex.has_equation(s) && !touching[s].empty()) able.push_back(s);
  if (able.empty()) return {};
  std::vector<int> centres{able[random() % able.size()]}, rim;
  std::unordered_set<int> seen{centres[0]};
  const auto look_around = [&](int site) {
    for (const auto stencil : touching[site])
      for (const int other : complex.vertices(stencil))
        if (complex.has_equation(other) && seen.insert(other).second) rim.push_back(other);
  };
  look_around(centres[0]);
  while (static_cast<int>(centres.size()) < count && !rim.empty()) {
    std::swap(rim[random() % rim.size()], rim.back());
    centres.push_back(rim.back());
    rim.pop_back();
    look_around(centres.back());
  }
  return centres;
}

ComplexForm::ComplexForm(const ComplexSystem& system, ComplexRegion region, std::span<const double> y, bool wrong_sign)
    : system_(system), region_(std::move(region)) {
  const int d = system.components();
  const Complex& complex = system.complex();
  const std::size_t nodes = region_.sites().size() * at(d);
  equation_.assign(nodes, -1), at_boundary_.assign(nodes, 0);
  const auto place = [&](int site) {
    return at(std::ranges::lower_bound(region_.sites(), site) - region_.sites().begin());
  };
  for (const int site : region_.interior())
    for (int a = 0; a < d; ++a) equation_[place(site) * at(d) + at(a)] = equations_++;
  for (const int site : region_.boundary())
    for (int a = 0; a < d; ++a) at_boundary_[place(site) * at(d) + at(a)] = 1;
  system.each_jacobian(region_.stencils(), y, [&](int stencil, const Assembly::Local& here) {
    Local local{{}, {here.derivatives.begin(), here.derivatives.end()}};
    for (const int site : complex.vertices(stencil))
      for (int a = 0; a < d; ++a) local.nodes.push_back(place(site) * at(d) + at(a));
    const std::size_t size = local.nodes.size();
    for (std::size_t m = 0; wrong_sign && size > 1 && m < size; ++m) local.J[m] = -local.J[m];
    locals_.push_back(std::move(local));
  });
}

std::vector<ComplexForm::Values> ComplexForm::first_variations(int count, std::mt19937_64& random) const {
  // Dense: regions are small. The columns of Q after the first rank(B), Bᵀ P = Q R, span the null space of B.
  Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(equation_.size()), equations_);
  for (const Local& local : locals_)
    for (std::size_t i = 0; i < local.nodes.size(); ++i)
      for (std::size_t m = 0; m < local.nodes.size(); ++m)
        if (equation_[local.nodes[i]] >= 0)
          transposed(static_cast<Eigen::Index>(local.nodes[m]), equation_[local.nodes[i]]) +=
              local.J[i * local.nodes.size() + m];
  // Equations of one size, whatever their time steps are: rank is judged by size.
  for (Eigen::Index n = 0; n < transposed.cols(); ++n)
    if (const double norm = transposed.col(n).norm(); norm > 0) transposed.col(n) /= norm;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  std::normal_distribution<double> normal;
  std::vector<Values> variations;
  for (int v = 0; v < count; ++v) {
    Eigen::VectorXd c = Eigen::VectorXd::Zero(transposed.rows());
    for (Eigen::Index n = qr.rank(); n < c.size(); ++n) c[n] = normal(random);
    c.applyOnTheLeft(qr.householderQ());
    variations.emplace_back(c.data(), c.data() + c.size());
  }
  return variations;
}

double ComplexForm::linearised(const Values& V) const {
  std::vector<Balance> E(equation_.size());
  for (const Local& local : locals_)
    for (std::size_t i = 0; i < local.nodes.size(); ++i)
      for (std::size_t m = 0; m < local.nodes.size(); ++m)
        E[local.nodes[i]].add(local.J[i * local.nodes.size() + m] * V[local.nodes[m]]);
  double worst = 0;
  for (std::size_t n = 0; n < E.size(); ++n)
    if (equation_[n] >= 0) worst = std::max(worst, E[n].relative());
  return worst;
}

namespace {

std::vector<double> gathered(const std::vector<std::size_t>& nodes, const std::vector<double>& V) {
  std::vector<double> values;
  for (const std::size_t n : nodes) values.push_back(V[n]);
  return values;
}

}  // namespace

Balance ComplexForm::form_formula(const Values& V, const Values& W) const {
  Balance balance;
  for (const Local& local : locals_) {
    const std::vector<double> v = gathered(local.nodes, V), w = gathered(local.nodes, W);
    for (std::size_t i = 0; i < local.nodes.size(); ++i)
      if (at_boundary_[local.nodes[i]]) add_form(balance, i, local.J, v, w);
  }
  return balance;
}

Balance ComplexForm::local_identity(const Values& V, const Values& W) const {
  Balance worst;
  for (const Local& local : locals_) {
    Balance balance;
    const std::vector<double> v = gathered(local.nodes, V), w = gathered(local.nodes, W);
    for (std::size_t i = 0; i < local.nodes.size(); ++i) add_form(balance, i, local.J, v, w);
    if (worst.count == 0 || worse(balance.relative(), worst.relative())) worst = balance;
  }
  return worst;
}

std::optional<std::size_t> ComplexForm::coupling_node() const {
  std::vector<double> felt(equation_.size(), 0.0);
  for (const Local& local : locals_)
    for (std::size_t i = 0; i < local.nodes.size(); ++i)
      for (std::size_t m = 0; m < local.nodes.size(); ++m)
        if (equation_[local.nodes[i]] >= 0 && at_boundary_[local.nodes[m]])
          felt[local.nodes[m]] += std::abs(local.J[i * local.nodes.size() + m]);
  const auto most = std::ranges::max_element(felt);
  if (most == felt.end() || *most == 0) return std::nullopt;
  return at(most - felt.begin());
}

}  // namespace delf
