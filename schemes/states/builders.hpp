// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "schemes/state.hpp"

namespace delf::initial {

// One for each row of the table in make_state.cpp; make_state has already seen to it that the theory has the state, in
// this kind of space.

std::unique_ptr<State> mps_collision(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink(const StateRequest&, const Lattice&);
std::unique_ptr<State> antikink(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_antikink(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_kink(const StateRequest&, const Lattice&);
std::unique_ptr<State> breather(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_train(const StateRequest&, const Lattice&);
std::unique_ptr<State> plane_wave(const StateRequest&, const Lattice&);
std::unique_ptr<State> wave_packet(const StateRequest&, const Lattice&);
std::unique_ptr<State> kepler_orbit(const StateRequest&, const Lattice&);
std::unique_ptr<State> pendulum_swing(const StateRequest&, const Lattice&);
std::unique_ptr<State> coupled_kinks(const StateRequest&, const Lattice&);
std::unique_ptr<State> coupled_breathers(const StateRequest&, const Lattice&);
std::unique_ptr<State> charged_wave(const StateRequest&, const Lattice&);
std::unique_ptr<State> charged_packet(const StateRequest&, const Lattice&);
std::unique_ptr<State> great_circle(const StateRequest&, const Lattice&);
std::unique_ptr<State> noise(const StateRequest&, const Lattice&);

}  // namespace delf::initial
