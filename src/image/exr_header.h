// A look at the header of an OpenEXR file before the library reads it.
#pragma once

#include <string_view>

#include "src/base/error.h"

namespace dapple {

/// Throws `Error` at `location` where an attribute of the header, or of one of the headers of a file of several parts,
/// does not take the bytes that it claims. OpenEXR 3.1 gives some attributes the memory that the file says they take
/// (up to 4 GB) before it reads them, and reads others by their type, whatever size is claimed. Other damage is left to
/// the library, which says what it is.
void CheckExrHeader(std::string_view bytes, const FileLocation& location);

}  // namespace dapple
