// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <utility>

namespace delf {

/// Numbers, one for each field, that are given for all times: the value at a boundary that moves, or what flows in there.
class GivenInTime {
 public:
  virtual ~GivenInTime() = default;
  virtual double value(int field, double t) const = 0;
  /// Its derivative by t.
  virtual double rate(int field, double t) const = 0;
};

/// The numbers in the reverse order, from a time T back to 0.
class BackFrom final : public GivenInTime {
 public:
  BackFrom(double T, std::shared_ptr<const GivenInTime> of) : T_(T), of_(std::move(of)) {}
  double value(int field, double t) const override { return of_->value(field, T_ - t); }
  double rate(int field, double t) const override { return -of_->rate(field, T_ - t); }

 private:
  double T_;
  std::shared_ptr<const GivenInTime> of_;
};

}  // namespace delf
