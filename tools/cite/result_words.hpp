// SPDX-License-Identifier: MIT
#pragma once
#include "tools/cite/paper_text.hpp"
#include "tools/results/result_folder.hpp"

namespace delf {

/// The numbers of a folder of results: of its run, its verification, convergence, stability, sweep and comparison.
void say_results(PaperText&, const ResultFolder&);
/// The version of delf, the machine and the compiler; those of this program, where there are no results. `stores_rows`:
/// by HDF5.
void say_program(PaperText&, const ResultFolder*, bool stores_rows);

}  // namespace delf
