// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_sum.hpp"

#include <set>
#include <tuple>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int N = 37, halo = 3, rows_given = 5;

struct TestTerm {
  int row, shift;
  double coefficient;
  int before = 0;  ///< of changes
};

/// Random rows on a circle, and sums over them by plain loops over the sites.
struct Sums {
  RowLayout layout{Lattice::circle(N, 1), halo};
  std::vector<Row> values;
  RowBuffer rows{layout, rows_given};
  std::vector<const double*> bases;
  RowSum::Rows read;  ///< these
  std::vector<TestTerm> differences, plain, changes;
  double constant = 0;
  Random random{5};

  Sums() {
    for (int r = 0; r < rows_given; ++r) {
      values.push_back(random_row(random, N, 1));
      layout.scatter(values.back(), rows.row(r));
      bases.push_back(rows.row(r));
    }
    read.row = bases.data();
  }
  /// So many random terms of either kind.
  void choose(int of_differences, int of_plain) {
    const auto some = [&](int count) {
      std::vector<TestTerm> terms;
      for (int n = 0; n < count; ++n)
        terms.push_back({static_cast<int>(random(0, rows_given - 0.001)), static_cast<int>(random(-halo, halo + 0.999)),
                         random(-2, 2)});
      return terms;
    };
    differences = some(of_differences), plain = some(of_plain);
    constant = random(-1, 1);
  }
  /// Differences to the sites on either side, as the usual schemes have them, in either order.
  void choose_both_sides(bool next_first, int of_plain) {
    choose(2, of_plain);
    differences[1].row = differences[0].row;
    differences[0].shift = next_first ? 1 : -1, differences[1].shift = -differences[0].shift;
  }
  /// Changes of one row at these shifts; or of any rows.
  void choose_changes(const std::vector<int>& shifts, bool of_one_row = true) {
    changes.clear();
    const auto row = [&] { return static_cast<int>(random(0, rows_given - 0.001)); };
    const int changed = row(), before = row() == changed ? (changed + 1) % rows_given : (changed + 2) % rows_given;
    for (int shift : shifts)
      changes.push_back({of_one_row ? changed : row(), shift, random(-2, 2), of_one_row ? before : row()});
  }
  /// All plain terms have one coefficient, and what is as far to either side.
  void make_even() {
    for (auto* terms : {&differences, &plain})
      for (TestTerm& t : *terms) t.coefficient = terms->front().coefficient;
    for (TestTerm& t : changes)
      if (t.shift != 0) t.coefficient = constant;
  }
  /// Plain terms are those of one row or two at sites 0 and −1, in any order.
  void make_pairs() {
    const int one = plain.front().row, other = (one + 1) % rows_given;
    const std::pair<int, int> at[] = {{one, 0}, {one, -1}, {other, -1}, {other, 0}};
    for (std::size_t n = 0; n < plain.size(); ++n) std::tie(plain[n].row, plain[n].shift) = at[n];
  }
  RowSum sum() const {
    RowSum result;
    for (const TestTerm& t : differences) result.add_difference(t.row, t.shift, t.coefficient);
    for (const TestTerm& t : plain) result.add(t.row, t.shift, t.coefficient);
    for (const TestTerm& t : changes) result.add_change(t.row, t.before, t.shift, t.coefficient);
    result.add_constant(constant / 4);
    result.add_constant(3 * constant / 4);
    return result;
  }
  double at(int row, int i) const {
    return values[static_cast<std::size_t>(row)][static_cast<std::size_t>((i + N) % N)];
  }
  double expected(int i) const {
    double total = constant;
    for (const TestTerm& t : differences) total += t.coefficient * (at(t.row, i + t.shift) - at(t.row, i));
    for (const TestTerm& t : plain) total += t.coefficient * at(t.row, i + t.shift);
    for (const TestTerm& t : changes) total += t.coefficient * (at(t.row, i + t.shift) - at(t.before, i + t.shift));
    return total;
  }
  double expected_absolute(int i) const {
    double total = 0;
    for (const TestTerm& t : differences) total += std::abs(t.coefficient * (at(t.row, i + t.shift) - at(t.row, i)));
    for (const TestTerm& t : plain) total += std::abs(t.coefficient * at(t.row, i + t.shift));
    for (const TestTerm& t : changes)
      total += std::abs(t.coefficient * (at(t.row, i + t.shift) - at(t.before, i + t.shift)));
    return total;
  }
};

/// What a pass hands out, checked pack by pack: each pack of the range once and in order, and how far sums are off.
struct Collect {
  const Sums* sums;
  PackRange range;
  int next, packs = 0;
  bool in_order = true;
  double worst = 0;
  Collect(const Sums& s, PackRange r) : sums(&s), range(r), next(r.first) {}
  void operator()(std::ptrdiff_t at, Pack sum) {
    look(at, sum, [&](int i) { return sums->expected(i); });
  }
  void look(std::ptrdiff_t at, Pack sum, const auto& expected) {
    in_order = in_order && at == sums->layout.at(next);
    for (int l = 0; l < lanes; ++l) {
      const int i = ((sums->layout.start(l) + next) % N + N) % N;
      const double off = std::abs(sum[l] - expected(i));
      if (!(off <= worst)) worst = off;
    }
    ++next, ++packs;
  }
};

std::vector<PackRange> ranges(const RowLayout& layout) {
  const int M = layout.packs();
  return {layout.all(), {0, M - 1}, {1, M}, {1, M - 1}, {2, 3}, {2, 2}};
}
int count(PackRange r) { return r.last - r.first; }

constexpr double rounding = 2e-15 * 14;  // so many terms of size 4

constexpr int next_first = 5, last_first = 6;  // two differences, to both sides

/// Shifts of changes: those that are compiled, in any order, and others.
const std::vector<std::vector<int>> shifts_of_changes{{},         {0},     {1},       {-1, 0, 1},
                                                      {1, -1, 0}, {0, 1},  {0, 0, 1}, {-2, 0, 2}};

/// Random sums with every number of terms, over every range of packs.
void for_each_sum(const auto& check) {
  Sums sums;
  enum class Plain { any, alike, pairs };
  for (const Plain kind : {Plain::any, Plain::alike, Plain::pairs})
    for (int differences : {0, 1, 2, 3, 4, next_first, last_first})
      for (int plain = 0; plain <= 9; ++plain)
        for (const auto& shifts : shifts_of_changes)
          for (const bool of_one_row : {true, false}) {
            if (shifts.size() < 2 && !of_one_row) continue;
            if (kind == Plain::pairs && plain != 2 && plain != 4) continue;
            if (differences > 4) sums.choose_both_sides(differences == next_first, plain);
            else sums.choose(differences, plain);
            sums.choose_changes(shifts, of_one_row);
            if (kind != Plain::any) sums.make_even();
            if (kind == Plain::pairs) sums.make_pairs();
            RowSum sum = sums.sum();
            sum.bind(sums.read);
            for (const PackRange range : ranges(sums.layout)) {
              CAPTURE(static_cast<int>(kind), differences, plain, shifts, of_one_row, range.first, range.last);
              check(sums, sum, range);
            }
          }
}

}  // namespace

TEST_CASE("a pass over shifted rows is the plain sum, for every number of terms, over any packs") {
  for_each_sum([](const Sums& sums, const RowSum& sum, PackRange range) {
    const Collect seen = sum.pass(sums.layout, range, Collect(sums, range));
    CHECK(seen.packs == count(range));
    CHECK(seen.in_order);
    CHECK(seen.worst < rounding);
  });
}

TEST_CASE("a pass whose number of terms is compiled agrees with one whose number is not") {
  // Terms with the coefficient 0 make the numbers 4 and 9, which are not compiled.
  Sums sums;
  for (int differences : {0, 2})
    for (int plain = 0; plain <= 8; ++plain) {
      sums.choose(differences, plain);
      std::vector<Pack> compiled, counted;
      const auto into = [](std::vector<Pack>& packs) {
        return [&packs](std::ptrdiff_t, Pack p) { packs.push_back(p); };
      };
      RowSum sum = sums.sum();
      sum.bind(sums.read);
      sum.pass(sums.layout, sums.layout.all(), into(compiled));
      for (int n = plain; n < 9; ++n) sum.add(0, 0, 0);
      for (int n = differences; n < 4; ++n) sum.add_difference(0, 1, 0);
      sum.bind(sums.read);
      sum.pass(sums.layout, sums.layout.all(), into(counted));
      CAPTURE(differences, plain);
      REQUIRE(compiled.size() == counted.size());
      double worst = 0;
      for (std::size_t v = 0; v < compiled.size(); ++v)
        worst = std::max(worst, max_or_nan(abs(compiled[v] - counted[v])));
      CHECK(worst < rounding);
    }
}

TEST_CASE("two sums that take turns give each pack its own, whichever comes first") {
  Sums one, other;
  struct Pick {
    const Sums *one, *other;
    int phase, next;
    Collect seen[2];
    Pick(const Sums& a, const Sums& b, PackRange range, int of_phase)
        : one(&a), other(&b), phase(of_phase), next(range.first), seen{{a, range}, {b, range}} {}
    Collect& turn() {
      Collect& mine = seen[(next + phase) % 2 != 0];
      mine.next = next++;
      return mine;
    }
    void operator()(std::ptrdiff_t at, Pack sum) { turn()(at, sum); }
    void operator()(std::ptrdiff_t at, Pack sum, Pack absolute) {
      Collect& mine = turn();
      mine.look(at, sum, [&](int i) { return mine.sums->expected(i); });
      --mine.next, --mine.packs;
      mine.look(at, absolute, [&](int i) { return mine.sums->expected_absolute(i); });
    }
    int packs() const { return seen[0].packs + seen[1].packs; }
    double worst() const { return std::max(seen[0].worst, seen[1].worst); }
  };
  int compiled = 0;
  for (int differences : {0, 1, 2, next_first, last_first})
    for (int plain = 0; plain <= 8; ++plain)
      for (int more : {0, 1}) {
        if (differences > 4) {
          one.choose_both_sides(differences == next_first, plain), other.choose_both_sides(true, plain + more);
          for (TestTerm& t : other.differences) t.row = one.differences[0].row;
          compiled += plain <= 3 && more == 0;
        } else {
          one.choose(differences, plain), other.choose(differences, plain + more);
        }
        // Those of the unknown row, as bricks have them.
        one.choose_changes(more ? std::vector<int>{} : std::vector<int>{0});
        other.changes = one.changes;
        for (TestTerm& t : other.changes) t.coefficient = other.random(-2, 2);
        if (plain % 2 != 0) one.make_even();
        if (plain % 4 == 3) other.make_even();
        other.values = one.values;
        RowSum even = one.sum(), odd = other.sum();
        even.bind(one.read), odd.bind(one.read);
        even.take_turns_with(odd);
        for (int phase : {0, 1})
          for (const PackRange range : ranges(one.layout)) {
            CAPTURE(differences, plain, more, phase, range.first, range.last);
            one.read.phase = phase;
            const Pick summed = even.pass(one.layout, range, Pick(one, other, range, phase));
            CHECK(summed.packs() == count(range));
            CHECK(summed.worst() < rounding);
            const Pick measured = even.measure(one.layout, range, Pick(one, other, range, phase));
            CHECK(measured.worst() < rounding);
            if (count(range) == 0 || (differences == 0 && plain == 0)) continue;
            one.read.phase = 1 - phase;  // the wrong one
            CHECK(even.pass(one.layout, range, Pick(one, other, range, phase)).worst() > 1e-3);
          }
      }
  CHECK(compiled == 8);
}

TEST_CASE("sums that take turns may have changes of other rows, or at other sites") {
  Sums one, other;
  for (const std::vector<int>& shifts : {std::vector<int>{0}, {2}, {-1, 0, 1}, {0, 1, 2}}) {
    one.choose_both_sides(true, 2), other.choose_both_sides(true, 2);
    for (TestTerm& t : other.differences) t.row = one.differences[0].row;
    one.choose_changes(shifts.size() == 1 ? std::vector<int>{0} : std::vector<int>{-1, 0, 1});
    other.choose_changes(shifts);
    for (TestTerm& t : one.changes) t.row = 0, t.before = 1;
    for (TestTerm& t : other.changes) t.row = 2, t.before = 3;
    other.values = one.values;
    RowSum even = one.sum(), odd = other.sum();
    even.bind(one.read), odd.bind(one.read);
    even.take_turns_with(odd);
    Collect seen[2] = {{one, one.layout.all()}, {other, one.layout.all()}};
    int next = 0;
    even.measure(one.layout, one.layout.all(), [&](std::ptrdiff_t at, Pack sum, Pack) {
      Collect& mine = seen[next % 2];
      mine.next = next++;
      mine(at, sum);
    });
    CAPTURE(shifts);
    for (const Collect& mine : seen) CHECK(mine.worst < rounding);
  }
}

TEST_CASE("measure gives the sum and the sum of absolute values") {
  for_each_sum([](const Sums& sums, const RowSum& sum, PackRange range) {
    Collect seen(sums, range), sizes(sums, range);
    sum.measure(sums.layout, range, [&](std::ptrdiff_t at, Pack value, Pack absolute) {
      seen(at, value);
      sizes.look(at, absolute, [&](int i) { return sums.expected_absolute(i); });
    });
    CHECK(seen.packs == count(range));
    CHECK(seen.in_order);
    CHECK(seen.worst < rounding);
    CHECK(sizes.worst < rounding);
  });
}

TEST_CASE("a scaled sum is scaled with its constant, and is that of the rows which stand where it reads") {
  Sums sums;
  for (int differences : {0, 2, 3}) {
    sums.choose(differences, 3);
    sums.choose_changes({0, 1});
    RowSum sum = sums.sum();
    sum.scale(-2.5);
    for (auto* terms : {&sums.differences, &sums.plain, &sums.changes})
      for (TestTerm& t : *terms) t.coefficient *= -2.5;
    sums.constant *= -2.5;
    RowSum::Rows read{sums.bases.data()};
    sum.bind(read);
    CHECK(sum.pass(sums.layout, sums.layout.all(), Collect(sums, sums.layout.all())).worst < rounding * 2.5);
    std::vector<const double*> turned(sums.bases);
    std::ranges::rotate(turned, turned.begin() + 1);
    std::vector<Row> kept = sums.values;
    std::ranges::rotate(sums.values, sums.values.begin() + 1);
    read.row = turned.data();
    CHECK(sum.pass(sums.layout, sums.layout.all(), Collect(sums, sums.layout.all())).worst < rounding * 2.5);
    sums.values = kept;
    CHECK(sum.pass(sums.layout, sums.layout.all(), Collect(sums, sums.layout.all())).worst > 0.01);  // of other rows
  }
}

TEST_CASE("the comparison of sums can fail: each term matters, and so do its shift and the constant") {
  Sums sums;
  const auto off = [&](RowSum sum) {
    sum.bind(sums.read);
    return sum.pass(sums.layout, sums.layout.all(), Collect(sums, sums.layout.all())).worst;
  };
  for (int differences : {0, 1, 2, 4, next_first, last_first})
    for (int plain : {1, 8, 9}) {
      if (differences > 4) sums.choose_both_sides(differences == next_first, plain);
      else sums.choose(differences, plain);
      const RowSum right = sums.sum();
      CHECK(off(right) < rounding);
      for (auto* terms : {&sums.differences, &sums.plain})
        for (TestTerm& t : *terms) {
          const TestTerm kept = t;
          t.coefficient += 1e-9;
          if (terms == &sums.plain || t.shift != 0) CHECK(off(right) > rounding);
          t = kept;
          t.shift += t.shift < halo ? 1 : -1;
          CHECK(off(right) > rounding);
          t = kept;
        }
      sums.constant += 1e-9;
      CHECK(off(right) > rounding);
    }
}
