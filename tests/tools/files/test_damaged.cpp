// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf;
using delf::testing::Folder;

namespace {

constexpr int frames = 6, sites = 5;

void write_fields(const std::filesystem::path& path) {
  const std::vector<double> space{0, 1, 2, 3, 4};
  FieldsFile file(path, space, 4, "scene", 1);  // a full block, and a part of one
  for (int frame = 0; frame < frames; ++frame) {
    RecordedRow row;
    for (int i = 0; i < sites; ++i) row[Role::field].push_back(1 + 0.1 * frame + 0.01 * i);
    file.append(0.5 * frame, row);
  }
  file.close();
}

// All that the file says; nothing if it is refused.
std::optional<std::vector<double>> contents(const std::filesystem::path& path) {
  try {
    const FieldsReader reader(path);
    std::vector<double> all{reader.winding().value_or(-99) * 1.0, reader.frames() * 1.0, reader.sites() * 1.0};
    for (int frame = 0; frame < reader.frames(); ++frame) {
      all.push_back(reader.time(frame).value_or(-99));
      for (const double x : reader.row(frame)) all.push_back(x);
    }
    return all;
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

}  // namespace

// HDF5 loses what it has allocated where a file is damaged: not for the leak checker.
TEST_CASE("a fields.h5 with a wrong byte, or cut short, is refused or says the same", "[slow]") {
  const Folder folder;
  const auto path = folder / "fields.h5", damaged = folder / "damaged.h5";
  write_fields(path);
  const std::string whole = delf::testing::read(path);
  const auto wanted = contents(path);
  REQUIRE(wanted);
  std::mt19937 random(1);
  int refused = 0;
  for (int n = 0; n < 300; ++n) {
    std::string bytes = whole;
    if (n % 10 == 0) bytes.resize(random() % whole.size());
    else bytes[random() % whole.size()] ^= static_cast<char>(1 << random() % 8);
    folder.write("damaged.h5", bytes);
    const auto found = contents(damaged);
    if (!found) ++refused;
    else CHECK(*found == *wanted);
  }
  CHECK(refused > 30);  // most of a small file is room that is not used
}

TEST_CASE("a fields.h5 that is still written can be read") {
  const Folder folder;
  const std::vector<double> space{0, 1, 2, 3, 4};
  FieldsFile file(folder / "fields.h5", space, 100, "scene", 1);
  RecordedRow row;
  row[Role::field].assign(sites, 1.5);
  for (int frame = 0; frame < 3; ++frame) file.append(frame, row);
  CHECK(file.flush(false).size == 3);
  const FieldsReader reader(folder / "fields.h5");
  CHECK(reader.frames() == 3);
  CHECK(reader.row(2)[4] == 1.5);
  file.close();
}

TEST_CASE("a fields.h5 whose disk filled opens as any other, and has the rows of its last flush") {
  const Folder folder;
  for (const int blocks : {60, 400, 2000}) {  // of 512 or 1024 bytes: files end there
    const delf::testing::Ran ran = delf::testing::delf_program(
        folder, "run kink --lattice.sites=64 --run.steps=4000 --output.every=1 --output.figures=off --out out",
        "ulimit -f " + std::to_string(blocks) + "; ");
    INFO(ran.err);
    REQUIRE(ran.code == 4);
    CHECK(delf::testing::contains(ran.err, "has room"));
    // as any reader opens it: with no words about writers
    const Hdf5Handle file(H5Fopen((folder / "out/fields.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    CHECK(file);
    if (blocks < 2000) continue;  // not one block of rows
    const FieldsReader reader(folder / "out/fields.h5");
    CHECK(reader.frames() >= 1024);
    // the last one was written: no row of nothing is behind them
    for (int frame = 0; frame < reader.frames(); ++frame) {
      const std::vector<double> row = reader.row(frame);
      CHECK(std::ranges::max(row) > std::ranges::min(row));
    }
  }
}
