// Writing a file so that a reader, a crash or a full disk never meets half of it.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace dapple {

/// Makes `bytes` the content of the file at `path`: a temporary file in the same folder is written, flushed to the disk
/// and renamed. On failure the temporary is removed, an older file of that name is left as it was, and `Error` is
/// thrown. A link is followed; what is no regular file (a device, a pipe) is written straight. Temporary files for the
/// same target that processes left behind which were killed while they wrote are removed first.
void WriteFileAtomically(const std::string& path, std::string_view bytes);
/// The same, with the pieces one after another as content.
void WriteFileAtomically(const std::string& path, std::initializer_list<std::string_view> pieces);

/// Makes and removes the temporary file of `WriteFileAtomically`, and what killed processes left of its kind; throws
/// the `Error` that this would.
void CheckWritable(const std::string& path);

}  // namespace dapple
