// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <memory>
#include <span>

#include "tools/complex/complex_scene.hpp"
#include "tools/files/fields_file.hpp"

namespace delf {

class SavedState;

/// Whether there is a fields.xdmf: XDMF takes two or three coordinates, of space, or t, x and y of a finite complex.
bool has_xdmf(const ComplexScene&);

/// fields.h5 of a scene on a mesh, and fields.xdmf and frames.h5 beside it, which ParaView opens.
class MeshFiles {
 public:
  MeshFiles(const ComplexScene&, const std::filesystem::path& folder, std::int64_t frames, bool node_times = false,
            const WrittenPart& kept = {});
  /// Without multipliers, where the theory has some, they are 0.
  void append(double time, std::span<const double> values, std::span<const double> multipliers = {},
              std::span<const double> node_times = {});
  /// See FieldsFile.
  const WrittenPart& flush(bool sync) { return file_->flush(sync); }
  void visit(SavedState&);
  void close();

 private:
  std::string xdmf() const;

  const ComplexScene& scene_;
  std::filesystem::path folder_;
  int corners_;
  std::vector<double> times_;
  std::unique_ptr<FieldsFile> file_;
};

}  // namespace delf
