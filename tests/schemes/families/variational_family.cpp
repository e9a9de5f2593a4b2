// SPDX-License-Identifier: MIT
#include "schemes/families/variational_family.hpp"

#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3, t = 1.4;

/// The largest difference, over the stencils anchored at each site of a row of random values, between rˡ and the sum
/// r(0) + J y + Σ_c weight(c, ·) out_c, relative to the largest rˡ.
double split_defect(const StencilFamily& family, const RowKernel& kernel, int N) {
  const Lattice ring = Lattice::circle(N, N * k);
  const int d = family.size() / family.pattern().size(), size = family.size();
  const auto& vertices = family.pattern().vertices;
  const auto [first, last] = std::ranges::minmax(vertices, {}, &Site::time);
  const auto [left, right] = std::ranges::minmax(vertices, {}, &Site::space);
  const RowLayout layout(ring, std::max({1, -left.space, right.space}));
  const int rows = last.time - first.time + 1;

  Random random(61);
  std::vector<Row> y;
  RowBuffer values(layout, rows * d), out(layout, std::max(1, kernel.outputs())), positions(layout, 1);
  std::vector<const double*> in;
  std::vector<double*> outputs;
  for (int r = 0; r < rows * d; ++r) {
    y.push_back(random_row(random, N, 0.2));
    layout.scatter(y.back(), values.row(r));
    in.push_back(values.row(r));
  }
  for (int c = 0; c < kernel.outputs(); ++c) outputs.push_back(out.row(c));
  Row x;
  for (int i = 0; i < N; ++i) x.push_back(ring.position(i));
  layout.scatter(x, positions.row(0));
  kernel.evaluate({&layout, in.data(), positions.row(0), t, h, k}, outputs.data());

  double worst = 0, largest = 0;
  std::vector<double> stencil(static_cast<std::size_t>(size)), r(stencil.size()), J(stencil.size() * stencil.size()),
      r0(stencil.size());
  for (int i = 0; i < N; ++i) {
    const Cell cell{h, k, t, ring.position(i)};
    for (std::size_t l = 0; l < vertices.size(); ++l)
      for (int a = 0; a < d; ++a)
        stencil[l * static_cast<std::size_t>(d) + static_cast<std::size_t>(a)] =
            y[static_cast<std::size_t>((vertices[l].time - first.time) * d + a)]
             [static_cast<std::size_t>(ring.wrapped(i + vertices[l].space))];
    family.residual(cell, stencil, r);
    kernel.linear_part({h, k, 0, 0}, J, r0);
    for (int n = 0; n < size; ++n) {
      const auto at = static_cast<std::size_t>(n);
      double sum = r0[at];
      for (int b = 0; b < size; ++b)
        sum += J[static_cast<std::size_t>(n * size + b)] * stencil[static_cast<std::size_t>(b)];
      for (int c = 0; c < kernel.outputs(); ++c) sum += kernel.weight(c, n) * out.row(c)[layout.slot(i)];
      worst = std::max(worst, std::abs(sum - r[at]));
      largest = std::max(largest, std::abs(r[at]));
    }
  }
  return worst / largest;
}
double split_defect(const StencilFamily& family, int N) { return split_defect(family, *family.row_kernel(), N); }

/// −√(1 − φ_t² + φ_x²), here with jets below 1
struct BornInfeld {
  auto operator()(const auto& j) const {
    return -sqrt(1.0 - 0.01 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x)) - cos(j.phi);
  }
};
/// Terms of the first degree in the derivatives, and a force: r(0) ≠ 0.
struct Pushed {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + 0.3 * j.phi_t * j.phi - 0.7 * j.phi_x + 2.0 * j.phi;
  }
};
struct Pair {
  static constexpr int components = 2;
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return j.phi_t[0] * j.phi_t[1] - 0.5 * j.phi_x[0] * j.phi_x[0] + sin(j.x + j.t) * cos(j.phi[0] - 2.0 * j.phi[1]);
  }
};

}  // namespace

TEST_CASE("the residual is its linear part and its outputs, for every theory and scheme, by rows and by one stencil") {
  for (const std::string& theory : theory_names()) {
    std::vector<std::string> schemes = stencil_names();
    schemes.push_back("guo");  // (5.14) shares its output among stencils
    for (const std::string& scheme : schemes)
      if (const auto family = family_of(problem_of(theory), scheme, h, k)) {
        CAPTURE(theory, scheme);
        for (int N : {5, 19}) CHECK(split_defect(*family, N) < 3e-15);
      }
  }
}

TEST_CASE("so it is for densities nonlinear in derivatives, with forces, of two components") {
  CHECK(split_defect(VariationalFamily<Hexagon, BornInfeld>(BornInfeld{}, h, k), 19) < 3e-15);
  CHECK(split_defect(VariationalFamily<NineTuple, BornInfeld>(BornInfeld{}, h, k), 19) < 3e-15);
  CHECK(split_defect(VariationalFamily<Rectangle, Pushed>(Pushed{}, h, k), 19) < 3e-15);
  CHECK(split_defect(VariationalFamily<SixTuple, Pair>(Pair{}, h, k), 19) < 3e-15);
}

TEST_CASE("the comparison can fail: outputs of another step") {
  // weights belong to h; evaluated with the family of 1.1 h the sums differ
  class Other : public RowKernel {
   public:
    Other(const RowKernel& right, const RowKernel& wrong) : RowKernel(right), right_(right), wrong_(wrong) {}
    void linear_part(const Cell& cell, std::span<double> J, std::span<double> r0) const override {
      wrong_.linear_part(cell, J, r0);
    }
    void evaluate(const SlabRows& rows, double* const* out, const PackRange& packs) const override {
      right_.evaluate(rows, out, packs);
    }

   private:
    const RowKernel &right_, &wrong_;
  };
  const VariationalFamily<Rectangle, SineGordon> right(SineGordon{1}, h, k), wrong(SineGordon{1}, h, k);
  const VariationalFamily<RectangleSymmetric, SineGordon> symmetric(SineGordon{1}, h, k);
  CHECK(split_defect(right, Other(right, wrong), 19) < 3e-15);
  CHECK(split_defect(right, Other(right, symmetric), 19) > 1e-3);
}

TEST_CASE("outputs are as few as the density allows") {
  const auto outputs = [](const std::string& theory, const std::string& stencil) {
    return family_of(problem_of(theory), stencil, h, k)->row_kernel()->outputs();
  };
  CHECK(outputs("wave", "hexagon") == 0);
  CHECK(outputs("klein-gordon", "hexagon") == 0);
  CHECK(outputs("sine-gordon", "hexagon") == 1);  // four points with one φ
  CHECK(outputs("sine-gordon", "rectangle") == 1);
  CHECK(outputs("sine-gordon", "nine-tuple") == 4);
  CHECK(VariationalFamily<Hexagon, BornInfeld>(BornInfeld{}, h, k).outputs() == 6);
}

TEST_CASE("a family says whether it has a Lagrangian, and whether it looks at its place") {
  CHECK(family_of(problem_of("sine-gordon"), "hexagon", h, k)->is_variational());
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "guo", h, k)->is_variational());
  CHECK(family_of(problem_of("sine-gordon-impurity"), "triangle", h, k)->is_placed());
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "triangle", h, k)->is_placed());
  CHECK_FALSE(family_of(problem_of("sine-gordon-impurity"), "guo", h, k));
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "pentagon", h, k));
}
