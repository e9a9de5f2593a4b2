// SPDX-License-Identifier: MIT
#include "tools/xdmf.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/complex/mesh_files.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/folder_lock.hpp"
#include "tools/files/lattice_xdmf.hpp"
#include "tools/files/mark_closed.hpp"
#include "tools/files/row_names.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

/// True if any reader opens it, not only one that knows how to read along with a writer.
bool is_closed(const fs::path& file) {
  quiet_hdf5();
  return static_cast<bool>(Hdf5Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose));
}

void write_for(const ComplexScene& mesh, const fs::path& folder, const FieldsReader& rows) {
  std::vector<double> times;
  for (int f = 0; f < rows.frames(); ++f) times.push_back(rows.time(f).value_or(f));
  write_mesh_xdmf(mesh, folder, times);
}

void write_for(const Scene& scene, const fs::path& folder, const FieldsReader&) {
  const InitialRows initial(scene);
  write_lattice_xdmf(folder, RowNames(build(scene, initial.winding())));
}

bool has_space(const ComplexScene& mesh) { return has_xdmf(mesh); }
bool has_space(const Scene& scene) { return scene.problem.lattice.space() != Space::point; }
int sites_of(const ComplexScene& mesh) { return mesh.sites(); }
int sites_of(const Scene& scene) { return scene.problem.lattice.sites(); }

}  // namespace

ExitCode write_xdmf(const fs::path& folder) {
  std::error_code none;
  const fs::path file = folder / "fields.h5";
  const auto refuse = [&](const std::string& why) {
    throw BadScene(fmt::format("command line: xdmf {}: {}", folder.string(), why));
  };
  if (!fs::is_directory(folder, none)) refuse("no such folder; name the folder of a run");
  if (!fs::exists(folder / "scene.ini", none)) refuse("has no scene.ini; name the folder of a run");
  if (!fs::exists(file, none)) refuse("has no fields.h5, which XDMF points into; run it with output.fields = on");
  const AnyScene any = read_any_scene(read_settings(folder / "scene.ini", {}));
  const FolderLock lock(folder);
  const bool was_killed = !is_closed(file);
  int frames = 0;
  std::visit(
      [&](const auto& scene) {
        if (!has_space(scene)) refuse("the rows have no space of one to three coordinates to show");
        try {
          {
            const FieldsReader rows(file);
            frames = rows.frames();
            if (frames == 0) refuse("fields.h5 has no row yet");
            if (rows.sites() != sites_of(scene))
              refuse("fields.h5 and scene.ini are of two runs; put both files of one here");
          }
          if (was_killed) mark_closed(file);
          if (!is_closed(file))
            throw SystemFailure(fmt::format("{}: cannot be marked closed; check its permissions", file.string()));
          write_for(scene, folder, FieldsReader(file));
        } catch (const BadScene&) {
          throw;
        } catch (const BadInput& bad) {
          throw BadScene(fmt::format("{}: {}", file.string(), bad.what()));
        }
      },
      any);
  std::string names;
  for (const char* name : {"fields.xdmf", "surface.xdmf", "frames.h5"})
    if (fs::exists(folder / name, none)) names += fmt::format(" {}", name);
  fmt::print("{}: {} rows in{}{}\n", folder.string(), frames, names,
             was_killed ? "; fields.h5, whose run was killed, is marked closed" : "");
  return ExitCode::done;
}

}  // namespace delf
