// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "schemes/state.hpp"

namespace delf::initial {

// One for each file of this folder; make_state has already seen to it that the theory has the state.

std::unique_ptr<State> mps_collision(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink(const StateRequest&, const Lattice&);
std::unique_ptr<State> antikink(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_antikink(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_kink(const StateRequest&, const Lattice&);
std::unique_ptr<State> breather(const StateRequest&, const Lattice&);
std::unique_ptr<State> kink_train(const StateRequest&, const Lattice&);
std::unique_ptr<State> plane_wave(const StateRequest&, const Lattice&);
std::unique_ptr<State> wave_packet(const StateRequest&, const Lattice&);
std::unique_ptr<State> noise(const StateRequest&, const Lattice&);

}  // namespace delf::initial
