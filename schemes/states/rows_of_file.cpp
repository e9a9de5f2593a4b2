// SPDX-License-Identifier: MIT
#include <limits>

#include "schemes/states/state_registry.hpp"

namespace delf {

extern const StateEntry rows_of_file_state;
const StateEntry rows_of_file_state{"file",
                                    "rows read from a file",
                                    {{"initial.file",
                                      std::string(),
                                      "a fields.h5, or a .csv of row,site,values; looked for beside the scene first",
                                      {},
                                      {},
                                      {},
                                      "none"},
                                     {"initial.frame",
                                      0,
                                      "the frame that row 0 is; the next frames are the next rows",
                                      {},
                                      {0, std::numeric_limits<int>::max()}}},
                                    {},
                                    {},
                                    Place::anywhere,
                                    nullptr,
                                    true};

}  // namespace delf
