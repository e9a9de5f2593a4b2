// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_solver.hpp"

#include <algorithm>
#include <exception>

#include "lattice/index.hpp"
#include "schemes/complex/level_part.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/thread_team.hpp"

namespace delf {
namespace {

/// Cuts a level into as many ranges of blocks, of about as many unknowns each.
std::vector<int> cuts_of(const ComplexPlan& plan, int begin, int end, int count) {
  std::vector<int> cuts{begin};
  const std::int64_t first = plan.first[begin], unknowns = plan.first[end] - first;
  for (int b = begin + 1; b < end; ++b)
    if ((plan.first[b] - first) * count >= unknowns * static_cast<std::int64_t>(cuts.size())) cuts.push_back(b);
  cuts.push_back(end);
  return cuts;
}

}  // namespace

ComplexSolver::ComplexSolver(const ComplexSystem& system, Options options) : system_(system), options_(options) {
  const Touching touching(system.complex());  // of no use behind the plan
  plan_ = make_plan(system.complex(), touching);
  system.row();  // made before threads ask for it
  struct Range {
    int first, last;
  };
  std::vector<Range> ranges;
  std::vector<std::int32_t> seen(system.complex().stencils(), -1);
  for (int begin = 0, end = 0; begin < plan_.blocks(); begin = end) {
    while (end < plan_.blocks() && plan_.level[end] == plan_.level[begin]) ++end;
    const int unknowns = plan_.first[end] - plan_.first[begin];
    std::vector<int> cuts = cuts_of(plan_, begin, end, std::max(1, unknowns / options.unknowns));
    // Stencils on two parts are evaluated twice: where the blocks of a level have no order that keeps neighbours together,
    // the level stays whole.
    std::int64_t once = 0, all = 0;
    const auto count = [&](int from, int to, std::int32_t mark, std::int64_t& sum) {
      for (std::int32_t n = plan_.first[from]; n < plan_.first[to]; ++n)
        for (const auto s : touching[plan_.equations[n]])
          if (seen[s] != mark) seen[s] = mark, ++sum;
    };
    std::int32_t mark = 2 * begin;
    count(begin, end, mark, once);
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) count(cuts[c], cuts[c + 1], ++mark, all);
    if (4 * all > 5 * once) cuts = {begin, end};
    level_.push_back(ranges.size());
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) ranges.push_back({cuts[c], cuts[c + 1]});
  }
  level_.push_back(ranges.size());
  parts_.resize(ranges.size());
  if (options.threads > 1 && shared_levels() > 0) team_ = std::make_unique<ThreadTeam>(options.threads);
  for_each(0, ranges.size(), [&](std::size_t p, std::size_t) {
    parts_[p] = std::make_unique<LevelPart>(system_, touching, plan_, ranges[p].first, ranges[p].last);
  });
}

ComplexSolver::~ComplexSolver() = default;
ComplexSolver::ComplexSolver(ComplexSolver&&) noexcept = default;

std::size_t ComplexSolver::bytes() const {
  std::size_t sum = 4 * (plan_.unknowns.size() + plan_.equations.size() + plan_.first.size() + plan_.level.size());
  for (const auto& part : parts_) sum += part->bytes();
  return sum;
}

bool ComplexSolver::is_direct() const {
  return std::ranges::all_of(parts_, [](const auto& part) { return part->is_direct(); });
}

int ComplexSolver::shared_levels() const {
  int count = 0;
  for (std::size_t l = 0; l + 1 < level_.size(); ++l) count += level_[l + 1] - level_[l] > 1;
  return count;
}

template <class Do>
void ComplexSolver::for_each(std::size_t first, std::size_t last, const Do& one) const {
  const FlushDenormals guard;  // as in the threads of a team
  const std::size_t shares = std::min(last - first, team_ ? at(team_->size()) : 1);
  std::vector<std::exception_ptr> failures(shares);
  const auto share = [&](int which) {
    const std::size_t w = which;
    for (std::size_t p = first + (last - first) * w / shares; p < first + (last - first) * (w + 1) / shares; ++p) try {
        one(p, w);
      } catch (...) {
        if (!failures[w]) failures[w] = std::current_exception();
      }
  };
  if (shares == 1) share(0);
  else if (shares > 1) team_->run(static_cast<int>(shares), share);
  // the first one in the order of parts, whoever came upon it
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

ComplexSolver::Report ComplexSolver::solve(std::span<double> y) const {
  std::vector<Report> of_share(std::max(1, options_.threads));
  for (std::size_t l = 0; l + 1 < level_.size(); ++l) {
    if (options_.is_to_end && options_.is_to_end()) of_share.front().ended = true;
    else
      for_each(level_[l], level_[l + 1],
               [&](std::size_t p, std::size_t share) { of_share[share].add(parts_[p]->find(y, options_)); });
    if (std::ranges::any_of(of_share, &Report::ended)) break;
    for_each(level_[l], level_[l + 1], [&](std::size_t p, std::size_t) {
      parts_[p]->write(y);
      if (plan_.levels > 1) parts_[p]->forget();  // all levels' factors would be several times the rest
    });
  }
  for (const Report& one : of_share) of_share.front().add(one);
  return of_share.front();
}

void ComplexSolver::Report::add(const Report& one) {
  iterations = std::max(iterations, one.iterations);
  correction = std::max(correction, one.correction);
  undetermined = std::max(undetermined, one.undetermined);
  ended = ended || one.ended;
}

}  // namespace delf
