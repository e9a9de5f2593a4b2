// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/kept_rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/index.hpp"

namespace delf {

KeptRows::KeptRows(const LatticeSystem& system, const RowLayout& layout, const RowEquations& equations, RowTable& table,
                   int history, double monodromy)
    : system_(system),
      layout_(layout),
      equations_(equations),
      table_(table),
      d_(system.components()),
      history_(history),
      monodromy_(monodromy) {}

void KeptRows::start(const std::vector<std::vector<double>>& rows) {
  leave_place();
  started_ = n_ = static_cast<std::int64_t>(rows.size()) - 1;
  known_ = std::min(static_cast<int>(rows.size()), history_);
  for (int back = 1; back <= known_; ++back) set(back, rows[rows.size() - at(back)]);
  for (int back = 1; back < known_; ++back) find_increment(back);
}

void KeptRows::set(int back, const std::vector<double>& values) {
  std::vector<double> one(layout_.sites());
  for (int a = 0; a < d_; ++a) {
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = values[i * at(d_) + at(a)];
    layout_.scatter(one, table_[equations_.y().row(back, a)], monodromy_);
  }
}

void KeptRows::find_increment(int back) {
  for (int a = 0; a < d_; ++a) {
    double* const v = table_[equations_.v().row(back, a)];
    const double *y = table_[equations_.y().row(back, a)], *before = table_[equations_.y().row(back + 1, a)];
    for (std::size_t i = 0; i < layout_.doubles(); ++i) v[i] = y[i] - before[i];
  }
}

void KeptRows::extrapolate() {
  for (int a = 0; a < d_; ++a) {
    const double *const y = table_[equations_.y().row(1, a)], *const v = table_[equations_.v().row(1, a)];
    double *const new_y = table_[equations_.y().row(0, a)], *const new_v = table_[equations_.v().row(0, a)];
    for (std::size_t i = 0; i < layout_.doubles(); ++i) new_v[i] = v[i], new_y[i] = y[i] + v[i];
  }
}

void KeptRows::advance() {
  table_.advance(equations_.y()), table_.advance(equations_.v());
  ++n_;
  known_ = std::min(known_ + 1, history_ + 1);
}

std::vector<double> KeptRows::values(int back) const {
  std::vector<double> values(layout_.sites() * d_), one(at(layout_.sites()));
  for (int a = 0; a < d_; ++a) {
    layout_.gather(table_[equations_.y().row(back, a)], one);
    for (std::size_t i = 0; i < one.size(); ++i) values[i * at(d_) + at(a)] = one[i];
  }
  return values;
}

double KeptRows::largest(int back) const {
  double most = 0;
  for (const double x : values(back)) most = std::max(most, std::abs(x));
  return most;
}

Window KeptRows::window(int rows) const {
  Window result{&system_.lattice(), d_, monodromy_, n_ - rows + 1, {}};
  for (int back = rows; back >= 1; --back) result.rows.push_back(values(number(back)));
  return result;
}

void KeptRows::require(int rows) const {
  if (rows > known_)
    throw std::logic_error("delf: rows before the newest were written over by step(false), or not stepped yet");
}

std::vector<const double*> KeptRows::all() const {
  std::vector<const double*> rows;
  for (int back = 0; back <= history_; ++back)
    for (int a = 0; a < d_; ++a) rows.push_back(table_[equations_.y().row(back, a)]);
  return rows;
}

void KeptRows::go_in_place() {
  kept_row_ = n_ - 1;
  for (const auto& ring : {equations_.y(), equations_.v()})
    for (int a = 0; a < d_; ++a) {
      beside_.push_back(table_[ring.row(0, a)]);
      table_[ring.row(0, a)] = table_[ring.row(1, a)];
    }
}

void KeptRows::advance_in_place() {
  ++n_;
  known_ = 1;
}

void KeptRows::leave_place() {
  if (!in_place()) return;
  std::size_t next = 0;
  for (const auto& ring : {equations_.y(), equations_.v()})
    for (int a = 0; a < d_; ++a) table_[ring.row(0, a)] = beside_[next++];
  beside_.clear();
  known_ = 1;
}

void KeptRows::go_back_to_kept() {
  leave_place();
  table_.go_back(equations_.y()), table_.go_back(equations_.v());
  n_ = kept_row_;
  known_ = 1;
}

void KeptRows::forget_oldest() { known_ = std::min(known_, history_); }

/// Rows with their halos, as they stand in their rings.
void KeptRows::visit(SavedState& state) {
  bool now_in_place = in_place();
  state("in place", now_in_place);
  if (now_in_place && !in_place()) go_in_place();
  if (!now_in_place) leave_place();
  for (const auto& [name, ring] : {std::pair{"y", equations_.y()}, {"increment", equations_.v()}})
    for (int back = 0; back < ring.held; ++back)
      for (int a = 0; a < d_; ++a) state.numbers(name, table_[ring.row(back, a)], layout_.doubles());
  state("newest row", n_), state("newest row of the start", started_), state("rows known", known_);
  state("row kept", kept_row_);
}

std::size_t KeptRows::bytes() const {
  return RowBuffer::bytes_of(layout_.doubles(), equations_.y().held * d_ + equations_.v().held * d_);
}

}  // namespace delf
