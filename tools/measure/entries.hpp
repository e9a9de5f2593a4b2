// SPDX-License-Identifier: MIT
#pragma once
#include "tools/measure/measurement.hpp"

namespace delf {

// at_a_place.cpp: φ at one x, over time
extern const MeasurementEntry value_measurement, minimum_measurement, maximum_measurement, minimum_time_measurement,
    maximum_time_measurement, crossings_measurement, frequency_measurement;
// kinks.cpp
extern const MeasurementEntry kinks_measurement, charge_measurement, position_measurement, speed_measurement;
// energy_left.cpp
extern const MeasurementEntry energy_left_measurement;
// energy_error_time.cpp
extern const MeasurementEntry energy_error_time_measurement;
// wavenumber.cpp
extern const MeasurementEntry wavenumber_measurement;
// mode.cpp
extern const MeasurementEntry mode_measurement, mode_rate_measurement;

}  // namespace delf
