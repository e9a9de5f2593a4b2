// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

namespace delf {

/// The value of a formula of numbers in the results of a command: names of its JSON, a measure by its name alone,
/// `levels[-1].order` for the last of a list, `point_limits[cgvi gauss2].theory` for the one of that name or scheme,
/// `checks[*].value` for the largest of all, `section[3].q2` for a line of section.csv, counted from 0. true is 1.
/// Throws BadInput for what is not there.
double result_number(const std::string& formula, const std::filesystem::path& folder);

}  // namespace delf
