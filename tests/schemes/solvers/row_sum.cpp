// SPDX-License-Identifier: MIT
#include "schemes/solvers/row_sum.hpp"

#include "lattice/index.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int halo = 3, rows_given = 5;
constexpr double rounding = 1e-14;

struct TestTerm {
  int row, shift;
  double coefficient;
};

/// Random rows on a circle, and sums over them by plain loops over the sites.
struct Sums {
  RowLayout layout;
  std::vector<Row> values;
  RowBuffer rows{layout, rows_given};
  std::vector<const double*> bases;
  std::vector<TestTerm> differences, plain;
  double constant = 0;
  Random random{5};

  explicit Sums(int N) : layout(Lattice::circle(N, 1), halo) {
    for (int r = 0; r < rows_given; ++r) {
      values.push_back(random_row(random, N, 1));
      layout.scatter(values.back(), rows.row(r));
      bases.push_back(rows.row(r));
    }
  }
  /// So many random terms of either kind; of few coefficients, so that neighbours are taken together.
  void choose(int of_differences, int of_plain, bool few_coefficients) {
    const auto some = [&](int count) {
      std::vector<TestTerm> terms;
      while (static_cast<int>(terms.size()) < count) {
        const TestTerm t{random.pick(0, few_coefficients ? 1 : rows_given - 1), random.pick(-halo, halo),
                         few_coefficients ? 0.5 * random.pick(1, 2) : random(-2, 2)};
        const auto same = [&](const TestTerm& other) { return other.row == t.row && other.shift == t.shift; };
        if (std::ranges::none_of(terms, same)) terms.push_back(t);
      }
      return terms;
    };
    differences = some(of_differences), plain = some(of_plain);
    constant = random(-1, 1);
  }
  RowSum sum() const {
    RowSum result;
    for (const TestTerm& t : differences) result.add_difference(t.row, t.shift, t.coefficient);
    for (const TestTerm& t : plain) result.add(t.row, t.shift, t.coefficient);
    result.add_constant(constant / 4);
    result.add_constant(3 * constant / 4);
    result.pair_up();
    return result;
  }
  double at(int row, int i) const {
    const int N = layout.sites();
    return values[row][(i % N + N) % N];
  }
  struct Expected {
    double sum, absolute;
  };
  Expected expected(int i) const {
    Expected total{constant, std::abs(constant)};
    const auto take = [&](double x) { total.sum += x, total.absolute += std::abs(x); };
    for (const TestTerm& t : differences) take(t.coefficient * (at(t.row, i + t.shift) - at(t.row, i)));
    for (const TestTerm& t : plain) take(t.coefficient * at(t.row, i + t.shift));
    return total;
  }
  /// How far a pack is off at most.
  double off(int pack, const double* found, bool absolute = false) const {
    double worst = 0;
    for (int l = 0; l < lanes; ++l) {
      const Expected right = expected(layout.start(l) + pack);
      const double difference = std::abs(found[l] - (absolute ? right.absolute : right.sum));
      if (!(difference <= worst)) worst = difference;
    }
    return worst;
  }
  /// The worst of evaluate() over the packs first, first + stride, …, and that no other pack was touched.
  double worst(const RowSum& of, int first, int last, int stride) const {
    RowBuffer out(layout, 1);
    std::fill_n(out.row(0), layout.doubles(), 777.0);
    of.evaluate(bases.data(), layout.at(first), layout.at(last), stride * lanes, out.row(0));
    double most = 0;
    for (int v = -halo; v < layout.packs() + halo; ++v) {
      const double* const pack = out.row(0) + layout.at(v);
      if (v >= first && v < last && (v - first) % stride == 0) most = std::max(most, off(v, pack));
      else if (pack[0] != 777.0 || pack[lanes - 1] != 777.0) most = 777;
    }
    return most;
  }
};

void for_each_sum(const auto& visit) {
  for (int N : {5, 37, 200})
    for (bool few : {false, true})
      for (int differences : {0, 1, 2, 3, 6})
        for (int plain : {0, 1, 2, 4, 9}) {
          Sums sums(N);
          sums.choose(differences, plain, few);
          CAPTURE(N, few, differences, plain);
          visit(sums, sums.sum());
        }
}

}  // namespace

TEST_CASE("a sum over rows is that by a plain loop, for any terms, packs and strides") {
  for_each_sum([](const Sums& sums, const RowSum& sum) {
    const int packs = sums.layout.packs();
    for (int stride : {1, 2})
      for (int first : {0, 1, packs / 2})
        for (int last : {packs, packs - 1, first + 1, first}) {
          if (last < first || first >= packs) continue;
          CHECK(sums.worst(sum, first, last, stride) < rounding);
        }
  });
}

TEST_CASE("dense sums stand one after the other") {
  for_each_sum([](const Sums& sums, const RowSum& sum) {
    const int packs = sums.layout.packs();
    for (int stride : {1, 2})
      for (int first : {0, packs / 2}) {
        std::vector<Pack> out(packs + 1, Pack(777.0));
        double* const numbers = reinterpret_cast<double*>(out.data());
        sum.evaluate_dense(sums.bases.data(), sums.layout.at(first), sums.layout.at(packs), stride * lanes, numbers);
        int next = 0;
        for (int v = first; v < packs; v += stride) CHECK(sums.off(v, numbers + next++ * lanes) < rounding);
        CHECK(numbers[next * lanes] == 777.0);
      }
  });
}

TEST_CASE("measure gives the sum and the sum of absolute values") {
  for_each_sum([](const Sums& sums, const RowSum& sum) {
    for (int stride : {1, 2}) {
      int next = 0;
      double worst = 0;
      sum.measure(sums.bases.data(), sums.layout.at(0), sums.layout.at(sums.layout.packs()), stride * lanes,
                  [&](std::ptrdiff_t at, Pack value, Pack absolute) {
                    CHECK(at == sums.layout.at(next));
                    alignas(Pack) double numbers[lanes], sizes[lanes];
                    value.store(numbers), absolute.store(sizes);
                    worst = std::max({worst, sums.off(next, numbers), sums.off(next, sizes, true)});
                    next += stride;
                  });
      CHECK(next >= sums.layout.packs());
      CHECK(worst < rounding);
    }
  });
}

TEST_CASE("a scaled sum is scaled with its constant, and is that of the rows which stand where it reads") {
  for (bool few : {false, true}) {
    Sums sums(37);
    sums.choose(3, 4, few);
    RowSum sum = sums.sum();
    sum.scale(-2.5);
    for (auto* terms : {&sums.differences, &sums.plain})
      for (TestTerm& t : *terms) t.coefficient *= -2.5;
    sums.constant *= -2.5;
    const int packs = sums.layout.packs();
    CHECK(sums.worst(sum, 0, packs, 1) < 2.5 * rounding);
    std::ranges::rotate(sums.bases, sums.bases.begin() + 1);
    CHECK(sums.worst(sum, 0, packs, 1) > 0.01);  // of other rows
    std::ranges::rotate(sums.values, sums.values.begin() + 1);
    CHECK(sums.worst(sum, 0, packs, 1) < 2.5 * rounding);
  }
}

TEST_CASE("a sum knows that it is one row alone") {
  RowSum sum;
  CHECK(sum.one_row().row == -1);
  sum.add(3, -2, 1);
  CHECK((sum.one_row().row == 3 && sum.one_row().by == -2 * lanes));
  RowSum scaled = sum, more = sum, with_constant = sum;
  scaled.scale(2), more.add(1, 0, 1), with_constant.add_constant(1);
  for (const RowSum* other : {&scaled, &more, &with_constant}) CHECK(other->one_row().row == -1);
}

TEST_CASE("the comparison of sums can fail: each term matters, and so do its shift and the constant") {
  for (bool few : {false, true}) {
    Sums sums(37);
    sums.choose(4, 5, few);
    const RowSum right = sums.sum();
    const auto off = [&] { return sums.worst(right, 0, sums.layout.packs(), 1); };
    CHECK(off() < rounding);
    for (auto* terms : {&sums.differences, &sums.plain})
      for (TestTerm& t : *terms) {
        const TestTerm kept = t;
        t.coefficient += 1e-9;
        if (terms == &sums.plain || t.shift != 0) CHECK(off() > rounding);
        t = kept;
        t.shift += t.shift < halo ? 1 : -1;
        CHECK(off() > rounding);
        t = kept;
      }
    sums.constant += 1e-9;
    CHECK(off() > rounding);
  }
}
