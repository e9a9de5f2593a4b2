// SPDX-License-Identifier: MIT
#include <limits>

#include "schemes/states/state_registry.hpp"

namespace delf {

extern const StateEntry rows_of_file_state;
const StateEntry rows_of_file_state{
    .name = "file",
    .formula = "rows read from a file",
    .parameters = {{"initial.file",
                    std::string(),
                    "a fields.h5, a .csv of row,site,values, or a .npy of rows; looked for beside the scene first",
                    {},
                    {},
                    {},
                    "none"},
                   {"initial.frame",
                    0,
                    "the frame that row 0 is; the next frames are the next rows",
                    {},
                    {0, std::numeric_limits<int>::max()}},
                   {"initial.time_step",
                    0.0,
                    "the step between the rows of the file; a run with another step starts from "
                    "their values and rates",
                    "time",
                    {0, std::numeric_limits<double>::infinity(), true},
                    {},
                    "that of the file's times, or else the run's"}},
    .exact = {},
    .approximate = {},
    .place = Place::anywhere,
    .build = nullptr,
    .any_theory = true,
    .sources = {"delf"}};

}  // namespace delf
