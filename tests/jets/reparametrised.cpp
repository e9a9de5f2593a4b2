// SPDX-License-Identifier: MIT
#include "jets/reparametrised.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

using Part = Reparametrised::Part;

/// One jet in every lane: (φ, X, φ_t, X_t, φ_x, X_x), or more of them.
struct At {
  ScratchRows jet, g, H, l;
  JetBatch batch;
  At(const BatchDensity& density, const std::vector<double>& values)
      : jet(density.variables(), lanes),
        g(density.variables(), lanes),
        H(density.variables() * density.variables(), lanes),
        l(1, lanes),
        batch{lanes, jet.data()} {
    for (std::size_t v = 0; v < values.size(); ++v) std::fill_n(jet[static_cast<int>(v)], lanes, values[v]);
    density.gradient(batch, g.data(), l[0]);
    density.hessian(batch, H.data());
  }
};

const std::vector<double> jet{0.4, 3.0, -0.7, 0.3, 1.1, 0.6};

double value(const BatchDensity& density, const std::vector<double>& at) { return At(density, at).l[0][0]; }

}  // namespace

TEST_CASE("a density on moving sites is the density at the field's own derivatives, times X_x") {
  // ℓ = ½φ_t² − ½φ_x² + cos φ − 1 at φ_t − φ_x X_t/X_x and φ_x/X_x
  const Reparametrised moving(expression("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1"), Part::whole);
  const double slope = 1.1 / 0.6, rate = -0.7 - slope * 0.3;
  CHECK(value(moving, jet) ==
        Approx((0.5 * rate * rate - 0.5 * slope * slope + std::cos(0.4) - 1) * 0.6).epsilon(1e-14));
}

TEST_CASE("its gradient and Hessian are those of finite differences, for any density and its parts") {
  for (const char* text :
       {"0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1", "0.5*phi_t^2 - 0.5*phi_x^2 + 0.2*phi*phi_t - phi^4",
        "-sqrt(1 + phi_x^2 - phi_t^2)*(2 + sin(phi))"}) {
    const auto of = expression(text);
    for (const Part part : {Part::whole, Part::quadratic, Part::potential}) {
      if (part != Part::whole && !Reparametrised::has_parts(*of)) continue;
      const Reparametrised moving(of, part);
      CAPTURE(text, static_cast<int>(part));
      const At here(moving, jet);
      constexpr double step = 1e-5;
      for (int a = 0; a < 6; ++a) {
        std::vector<double> up = jet, down = jet;
        up[a] += step, down[a] -= step;
        const At above(moving, up), below(moving, down);
        CHECK(here.g[a][0] == Approx((above.l[0][0] - below.l[0][0]) / (2 * step)).margin(1e-8));
        for (int b = 0; b < 6; ++b) {
          CHECK(here.H[a * 6 + b][0] == Approx((above.g[b][0] - below.g[b][0]) / (2 * step)).margin(1e-7));
          if (moving.is_zero(a, b)) CHECK(here.H[a * 6 + b][0] == 0);
        }
      }
    }
    if (Reparametrised::has_parts(*of))
      CHECK(value(Reparametrised(of, Part::whole), jet) ==
            Approx(value(Reparametrised(of, Part::quadratic), jet) + value(Reparametrised(of, Part::potential), jet)));
  }
}

TEST_CASE("densities that depend on the place have no sites that move") {
  CHECK_THROWS_AS(Reparametrised(expression("0.5*phi_t^2 - 0.5*phi_x^2 - x*phi^2"), Part::whole), BadInput);
}
