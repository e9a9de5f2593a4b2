// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "jets/expressions/expression.hpp"
#include "jets/simd/pack_math.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/double_sine_gordon.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

/// A user's density, compiled here and nowhere else: ℓ = ½φ_t² − ½φ_x² + m²(cos φ − 1), as
/// schemes/theories/sine_gordon.hpp has it.
struct UserDensity {
  double mass = 1;
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + (mass * mass) * (cos(j.phi) - 1.0);
  }
};

/// ℓ = ½φ_t² − ½φ_x² − ½φ²(1 − φ²/64)²: φ⁶, as wide as the collision is high.
struct PhiSix {
  auto operator()(const auto& j) const {
    const auto w = 1.0 - j.phi * j.phi / 64.0;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - 0.5 * (j.phi * j.phi) * (w * w);
  }
};

template <class Map, class D>
Side user_side(Map map, const D& density, const Collision& collision) {
  const auto evolution = std::make_shared<Evolution>(
      Scheme{map, density}.on(collision.lattice(), collision.time_step(), {.tolerance = collision.tolerance}));
  return side_of(std::shared_ptr<Stepper>(evolution, &evolution->stepper()), collision);
}

}  // namespace

void time_density(const Request& request) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print(
      "A density of this program's own source through delf::Scheme, against delf::Simulation; ns per site and "
      "step\n\n");
  const Table table({{"scheme", 20}, {"N", 8}, {"user's", 8}, {"built in", 8}, {"ratio", 24}});
  const auto compare = [&](const char* scheme, auto map) {
    for (const int sites : request.sites_or({255, 4095})) {
      const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
      const Pairing times = pair(user_side(map, UserDensity{}, collision), engine_side(collision), request.repeats);
      table.row({scheme, fmt::to_string(collision.sites), number(times.a / collision.sites),
                 number(times.b / collision.sites), in_words(times.ratio)});
    }
  };
  compare("triangle-vertex", triangle_vertex);
  compare("triangle", triangle);
  compare("rectangle-symmetric", rectangle_symmetric);

  fmt::print("\nA density as text (delf::expression) against the same one compiled\n\n");
  const Table of_texts({{"density", 20}, {"scheme", 20}, {"N", 8}, {"text", 8}, {"compiled", 8}, {"ratio", 24}});
  const auto compare_text = [&](const char* name, const char* text, const auto& density, const char* scheme, auto map) {
    for (const int sites : request.sites_or({255, 4095})) {
      const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
      const Pairing times =
          pair(user_side(map, expression(text), collision), user_side(map, density, collision), request.repeats);
      of_texts.row({name, scheme, fmt::to_string(collision.sites), number(times.a / collision.sites),
                    number(times.b / collision.sites), in_words(times.ratio)});
    }
  };
  const auto on_schemes = [&](const char* name, const char* text, const auto& density) {
    compare_text(name, text, density, "triangle-vertex", triangle_vertex);
    compare_text(name, text, density, "rectangle-symmetric", rectangle_symmetric);
  };
  on_schemes("sine-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1", SineGordon{});
  on_schemes("double-sine-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1 + 0.15*(cos(2*phi) - 1)",
             DoubleSineGordon{1, 0.3});
  on_schemes("phi6", "0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2*(1 - phi^2/64)^2", PhiSix{});
}

}  // namespace delf::bench
