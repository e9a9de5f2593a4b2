// SPDX-License-Identifier: MIT
#include "lattice/error.hpp"
#include "tests/fuzz/all_rows.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/plain_rows.hpp"

// Rows in HDF5, in the layout of fields.h5, or as a data set of any other.
void delf::fuzz::read_bytes(std::string_view bytes) {
  const std::filesystem::path path = written(".h5", bytes);
  try {
    read_dataset(path, "field");
  } catch (const BadInput&) {
  }
  const FieldsReader reader(path);
  reader.scene(), reader.positions(), reader.coordinates();
  read_all(reader);
}
