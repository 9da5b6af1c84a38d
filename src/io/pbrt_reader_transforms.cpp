// The statements that change the current transform.
#include <algorithm>

#include <fmt/format.h>

#include "src/io/nearest_name.h"
#include "src/io/pbrt_parameters.h"
#include "src/io/pbrt_reader.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

/// pbrt writes the numbers of a matrix column by column. The last one divides all others; of a projection, which
/// shapes and instances could not follow, the affine part remains.
Transform FromColumns(const std::array<double, 16>& numbers, const FileLocation& location, Diagnostics& diagnostics) {
  if (numbers[3] != 0 || numbers[7] != 0 || numbers[11] != 0)
    diagnostics.Warn(location, fmt::format("projections are not supported: the matrix's last row is {} {} {} {}, "
                                           "expected 0 0 0 1; its first three numbers are ignored",
                                           numbers[3], numbers[7], numbers[11], numbers[15]));
  const double w = numbers[15] != 0 ? numbers[15] : 1;
  double rows[16] = {};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) rows[4 * row + column] = numbers[4 * column + row] / w;
  rows[15] = numbers[15] / w;
  return Transform::FromRows(rows);
}

}  // namespace

void PbrtReader::Identity() { state_.SetTransform(Transform(), here_); }

void PbrtReader::Translate() {
  const auto n = ReadNumbers<3>();
  state_.Concatenate(Transform::Translate({n[0], n[1], n[2]}), here_);
}

void PbrtReader::Scale() {
  const auto n = ReadNumbers<3>();
  state_.Concatenate(Transform::Scale({n[0], n[1], n[2]}), here_);
}

void PbrtReader::Rotate() {
  const auto n = ReadNumbers<4>();
  const Vec3d axis(n[1], n[2], n[3]);
  const double largest = MaxAbsComponent(axis);
  if (largest == 0) throw Error(here_, "Rotate around the axis 0 0 0, expected an axis of some length");
  state_.Concatenate(Transform::Rotate(n[0], axis / largest), here_);
}

void PbrtReader::LookAt() {
  const auto n = ReadNumbers<9>();
  const Transform worldFromCamera =
      Transform::CameraToWorldLookAt({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]});
  if (worldFromCamera.IsSingular())
    throw Error(here_, "LookAt gives no view: expected a target away from the eye, and an up vector across the view");
  state_.Concatenate(worldFromCamera.Inverse(), here_);
}

void PbrtReader::SetTransform() { state_.SetTransform(FromColumns(ReadNumbers<16>(), here_, *diagnostics_), here_); }

void PbrtReader::ConcatTransform() { state_.Concatenate(FromColumns(ReadNumbers<16>(), here_, *diagnostics_), here_); }

void PbrtReader::CoordinateSystem() {
  coordinateSystems_[ReadName("a name of the coordinate system")] = state_.Now().transform;
}

void PbrtReader::CoordSysTransform() {
  const std::string name = ReadName("a name of a coordinate system");
  const auto found = coordinateSystems_.find(name);
  if (found != coordinateSystems_.end()) {
    state_.SetTransform(found->second, here_);
    return;
  }
  std::vector<std::string> names;
  for (const auto& entry : coordinateSystems_) names.push_back(entry.first);
  std::sort(names.begin(), names.end());
  diagnostics_->Warn(here_, fmt::format("no coordinate system is named {}; the transform stays{}", Quoted(name),
                                        DidYouMean(name, names)));
}

void PbrtReader::ActiveTransform() {
  const Token token = Lexer().Next();
  const bool isWord = token.kind == TokenKind::Word;
  if (!isWord || (token.text != "StartTime" && token.text != "EndTime" && token.text != "All"))
    throw Error(Lexer().Location(token),
                fmt::format("ActiveTransform: expected StartTime, EndTime or All, found {}", Describe(token)));
  state_.Now().startTimeActive = token.text != "EndTime";
  state_.Now().endTimeActive = token.text != "StartTime";
}

void PbrtReader::TransformTimes() { ReadNumbers<2>(); }

}  // namespace dapple
