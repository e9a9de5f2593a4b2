// SPDX-License-Identifier: MIT
#include "tests/fuzz/all_rows.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"
#include "tools/files/plain_rows.hpp"

// A table of text: a line for each row, or for each site of each row. Rows have three values.
void delf::fuzz::read_bytes(std::string_view bytes) { read_all(*open_plain_rows(written(".csv", bytes), 3, 1)); }
