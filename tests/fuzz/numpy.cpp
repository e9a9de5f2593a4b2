// SPDX-License-Identifier: MIT
#include "tests/fuzz/all_rows.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"
#include "tools/files/plain_rows.hpp"

// NumPy's .npz, or else .npy. Rows have three values.
void delf::fuzz::read_bytes(std::string_view bytes) {
  read_all(*open_plain_rows(written(bytes.starts_with("PK") ? ".npz" : ".npy", bytes), 3, 1));
}
