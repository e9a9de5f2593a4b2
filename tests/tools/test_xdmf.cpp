// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/hdf5_handle.hpp"

using namespace delf::testing;
using delf::Hdf5Handle;
namespace fs = std::filesystem;

namespace {

bool opens_plainly(const fs::path& file) {
  delf::quiet_hdf5();
  return static_cast<bool>(Hdf5Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose));
}

}  // namespace

TEST_CASE("XDMF written later is that of the run") {
  const Folder folder;
  const auto scene =
      GENERATE(as<std::string>(), "kink --run.until=1", "r-adaptive --run.steps=8", "sphere --run.steps=4");
  const std::string run = "run " + scene + " --output.every=2 --output.xdmf=on --output.figures=off --out out";
  REQUIRE(delf_program(folder, run).code == 0);
  const std::string fields = read(folder / "out/fields.xdmf"), surface = read(folder / "out/surface.xdmf"),
                    frames = read(folder / "out/frames.h5");
  for (const char* name : {"fields.xdmf", "surface.xdmf", "frames.h5"}) fs::remove(folder / "out" / name);
  const Ran ran = delf_program(folder, "xdmf out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK_FALSE(contains(ran.out, "killed"));
  CHECK(read(folder / "out/fields.xdmf") == fields);
  CHECK(read(folder / "out/surface.xdmf") == surface);
  CHECK(read(folder / "out/frames.h5").size() == frames.size());
}

TEST_CASE("the rows of a run that was killed are opened by any program once there is XDMF for them") {
  const Folder folder;
  const auto scene = GENERATE(as<std::string>(), "kink --lattice.sites=2000 --run.until=1e5", "sphere --run.until=1e5");
  const std::string start =
      "'" + program_path() + "' run " + scene +
      " --output.every=20 --output.checkpoint=0.1 --output.figures=off --out out > said 2>&1 & p=$!; "
      "while [ ! -s out/checkpoint ]; do sleep 0.05; done; sleep 0.3; ";
  // while it goes on, nothing is written
  const Ran ran = shell(folder, start + "'" + program_path() + "' xdmf out; code=$?; kill -9 $p; wait $p; exit $code");
  CHECK(ran.code == 4);
  CHECK(contains(ran.err, "another command writes to this folder"));
  const bool made_with_run = fs::exists(folder / "out/fields.xdmf");
  CHECK_FALSE(made_with_run);
  REQUIRE_FALSE(opens_plainly(folder / "out/fields.h5"));
  const int frames = delf::FieldsReader(folder / "out/fields.h5").frames();
  REQUIRE(frames > 1);
  const Ran after = delf_program(folder, "xdmf out");
  INFO(after.err);
  REQUIRE(after.code == 0);
  CHECK(contains(after.out, "is marked closed"));
  CHECK(opens_plainly(folder / "out/fields.h5"));
  CHECK(delf::FieldsReader(folder / "out/fields.h5").frames() == frames);
  CHECK(contains(read(folder / "out/fields.xdmf"), "/" + std::to_string(frames - 1) + "</DataItem>"));
  {  // the last frame through frames.h5, as ParaView reads it
    const Hdf5Handle file(H5Fopen((folder / "out/frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle phi(H5Dopen2(file, ("phi/" + std::to_string(frames - 1)).c_str(), H5P_DEFAULT), H5Dclose);
    const std::vector<double> row = delf::FieldsReader(folder / "out/fields.h5").row(frames - 1);
    std::vector<double> values(row.size());
    REQUIRE(H5Dread(phi, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    CHECK(values == row);
  }
  // and the run goes on from its checkpoint
  CHECK(shell(folder, "timeout --preserve-status -s INT 1 '" + program_path() + "' resume out").code == 130);
  CHECK(delf::FieldsReader(folder / "out/fields.h5").frames() >= 2);
}

TEST_CASE("XDMF has rows in space to point into, or says what is missing") {
  const Folder folder;
  check_refused(delf_program(folder, "xdmf"), {"xdmf what?"});
  check_refused(delf_program(folder, "xdmf nowhere"), {"no such folder"});
  check_refused(delf_program(folder, "xdmf . --run.until=1"), {"--run.until"});
  check_refused(delf_program(folder, "xdmf ."), {"scene.ini"});
  REQUIRE(delf_program(folder, "run pendulum --run.until=1 --output.figures=off --out point").code == 0);
  check_refused(delf_program(folder, "xdmf point"), {"no space"});
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --output.fields=off --out none").code == 0);
  check_refused(delf_program(folder, "xdmf none"), {"no fields.h5"});
}
