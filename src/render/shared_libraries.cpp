#include "src/render/shared_libraries.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include "src/base/content_hash.h"

namespace dapple {

namespace {

constexpr size_t kDigits = 8;

/// What is mapped: the program, whose name is empty, or a library.
struct MappedObject {
  std::string name;
  std::string id;
  std::vector<std::string> needed;
};

std::span<const ElfW(Phdr)> Segments(const dl_phdr_info& object) { return {object.dlpi_phdr, object.dlpi_phnum}; }

std::string_view BytesOf(const dl_phdr_info& object, const ElfW(Phdr) & segment) {
  return {reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr), segment.p_memsz};
}

/// The build id among the notes of a segment, in hexadecimal digits; "" where it is not.
std::string FindBuildId(std::string_view notes, size_t alignment) {
  const auto padded = [&](size_t size) { return (size + alignment - 1) / alignment * alignment; };
  constexpr std::string_view kOwner("GNU", 4);  // with the 0 at its end
  while (notes.size() >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes.data(), sizeof(head));
    const size_t content = padded(sizeof(head) + head.n_namesz), end = padded(content + head.n_descsz);
    if (end > notes.size()) break;
    if (head.n_type == NT_GNU_BUILD_ID && notes.substr(sizeof(head), head.n_namesz) == kOwner) {
      std::string id;
      for (const char byte : notes.substr(content, head.n_descsz))
        id += fmt::format("{:02x}", static_cast<uint8_t>(byte));
      return id;
    }
    notes.remove_prefix(end);
  }
  return "";
}

std::string HashOfCode(const dl_phdr_info& object) {
  constexpr ElfW(Word) kAccess = PF_R | PF_W | PF_X;
  ContentHash hash;
  for (const auto& segment : Segments(object))
    if (segment.p_type == PT_LOAD && (segment.p_flags & kAccess) == (PF_R | PF_X))
      hash.AddText(BytesOf(object, segment));
  return hash.Hex();
}

std::string IdOf(const dl_phdr_info& object) {
  for (const auto& segment : Segments(object)) {
    if (segment.p_type != PT_NOTE) continue;
    const size_t alignment = std::max<size_t>(segment.p_align, 4);
    if (std::string id = FindBuildId(BytesOf(object, segment), alignment); !id.empty()) return id;
  }
  return HashOfCode(object);
}

std::vector<std::string> NeededBy(const dl_phdr_info& object) {
  std::vector<std::string> needed;
  for (const auto& segment : Segments(object)) {
    if (segment.p_type != PT_DYNAMIC) continue;
    const auto* const entries = reinterpret_cast<const ElfW(Dyn)*>(object.dlpi_addr + segment.p_vaddr);
    ElfW(Addr) texts = 0;
    for (const auto* entry = entries; entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_STRTAB) texts = entry->d_un.d_ptr;
    if (texts < object.dlpi_addr) texts += object.dlpi_addr;  // not every loader writes the address itself there
    for (const auto* entry = entries; entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_NEEDED) needed.emplace_back(reinterpret_cast<const char*>(texts + entry->d_un.d_val));
  }
  return needed;
}

int Collect(dl_phdr_info* object, size_t, void* list) {
  const std::string_view path = object->dlpi_name;
  static_cast<std::vector<MappedObject>*>(list)->push_back(
      {std::string(path.substr(path.rfind('/') + 1)), IdOf(*object), NeededBy(*object)});
  return 0;
}

}  // namespace

std::string SharedLibraries() {
  std::vector<MappedObject> objects;
  dl_iterate_phdr(Collect, &objects);
  std::set<std::string> found;
  std::vector<std::string> names{""};
  while (!names.empty()) {
    const std::string name = std::move(names.back());
    names.pop_back();
    const auto object = std::ranges::find(objects, name, &MappedObject::name);
    if (object == objects.end()) continue;
    if (!name.empty() && !found.insert(name + " " + object->id.substr(0, kDigits)).second) continue;
    names.insert(names.end(), object->needed.begin(), object->needed.end());
  }
  return found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "));
}

}  // namespace dapple
