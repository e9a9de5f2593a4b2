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
// energy_range.cpp
extern const MeasurementEntry energy_minimum_measurement, energy_maximum_measurement;
// shape.cpp: of the last row
extern const MeasurementEntry mean_measurement, pulse_width_measurement, peak_measurement, peak_position_measurement;
// passages.cpp: when a level is passed
extern const MeasurementEntry crossing_time_measurement, section_value_measurement;
// line.cpp
extern const MeasurementEntry line_measurement;
// wavenumber.cpp
extern const MeasurementEntry wavenumber_measurement;
// mode.cpp
extern const MeasurementEntry mode_measurement, mode_rate_measurement, mode_return_measurement,
    mode_return_time_measurement;

}  // namespace delf
