#include "src/io/pbrt_state.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace dapple {

namespace {

bool IsFinite(const Transform& transform) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      if (!std::isfinite(transform.At(row, column))) return false;
  return true;
}

std::string_view BeginOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::Attribute:
      return "AttributeBegin";
    case BlockKind::Transform:
      return "TransformBegin";
    case BlockKind::Object:
      return "ObjectBegin";
    case BlockKind::Import:
      return "Import";
  }
  return "";
}

std::string_view EndOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::Attribute:
      return "AttributeEnd";
    case BlockKind::Transform:
      return "TransformEnd";
    case BlockKind::Object:
      return "ObjectEnd";
    case BlockKind::Import:
      return "end of the imported file";
  }
  return "";
}

}  // namespace

void ScopedNames::Define(const std::string& name, int index) {
  const auto [entry, isNew] = inScope_.try_emplace(name, index);
  undo_.push_back({name, isNew ? -1 : entry->second});
  entry->second = index;
  last_[name] = index;
}

int ScopedNames::Find(const std::string& name) const {
  for (const auto* names : {&inScope_, &last_}) {
    const auto found = names->find(name);
    if (found != names->end()) return found->second;
  }
  return -1;
}

std::vector<std::string> ScopedNames::All() const {
  std::vector<std::string> names;
  for (const auto& entry : last_) names.push_back(entry.first);
  std::sort(names.begin(), names.end());
  return names;
}

void ScopedNames::Rollback(std::size_t mark) {
  for (; undo_.size() > mark; undo_.pop_back()) {
    const Undo& undo = undo_.back();
    if (undo.index < 0)
      inScope_.erase(undo.name);
    else
      inScope_[undo.name] = undo.index;
  }
}

void PbrtState::Concatenate(const Transform& transform, const FileLocation& location) {
  SetTransform(now_.transform * transform, location);
}

void PbrtState::SetTransform(const Transform& transform, const FileLocation& location) {
  if (now_.startTimeActive != now_.endTimeActive && !motionWarned_) {
    diagnostics_.Warn(location, "motion is not supported; the transform at the start time is used");
    motionWarned_ = true;
  }
  if (!now_.startTimeActive) return;
  if (!IsFinite(transform)) throw Error(location, "the transform is beyond the range of double");
  now_.transform = transform;
}

void PbrtState::Begin(BlockKind kind, const FileLocation& location) {
  constexpr std::size_t kDeepest = 10'000;  // each takes half a kilobyte
  if (blocks_.size() >= kDeepest) throw Error(location, fmt::format("blocks are more than {} deep", kDeepest));
  blocks_.push_back({kind, now_, floatTextures.Mark(), spectrumTextures.Mark(), materials.Mark(), location});
}

void PbrtState::End(BlockKind kind, const FileLocation& location) {
  if (blocks_.empty()) throw Error(location, fmt::format("{} without {}", EndOf(kind), BeginOf(kind)));
  Block& block = blocks_.back();
  if (block.kind != kind)
    throw Error(location, fmt::format("{} within the block of {} at {}; expected {}", EndOf(kind), BeginOf(block.kind),
                                      block.location.ToString(), EndOf(block.kind)));
  if (kind == BlockKind::Transform && !transformBlocksSaveAll_) {
    now_.transform = block.saved.transform;
    now_.startTimeActive = block.saved.startTimeActive;
    now_.endTimeActive = block.saved.endTimeActive;
  } else {
    now_ = std::move(block.saved);
    floatTextures.Rollback(block.floatTextureMark);
    spectrumTextures.Rollback(block.spectrumTextureMark);
    materials.Rollback(block.materialMark);
  }
  blocks_.pop_back();
}

std::vector<PbrtState::OpenBlock> PbrtState::OpenBlocks(std::size_t count) const {
  std::vector<OpenBlock> open;
  for (std::size_t i = count; i < blocks_.size(); ++i)
    open.push_back(
        {fmt::format("{} without {}", BeginOf(blocks_[i].kind), EndOf(blocks_[i].kind)), blocks_[i].location});
  return open;
}

}  // namespace dapple
