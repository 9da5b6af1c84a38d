#include "src/render/shared_libraries.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

namespace dapple {
namespace {

bool HasLibrary(const std::string& libraries, const std::string& name) {
  return (", " + libraries).find(", " + name) != std::string::npos;
}

TEST(SharedLibraries, AreThoseThatDoTheArithmetic) {
  const std::string libraries = SharedLibraries();
  for (const char* name : {"libembree3.so", "libm.so", "libc.so", "libstdc++.so", "libtbb.so", "libOpenEXR"})
    EXPECT_TRUE(HasLibrary(libraries, name)) << name << " in " << libraries;
  EXPECT_FALSE(HasLibrary(libraries, "linux-vdso")) << libraries;
}

// Allocators and the like come and go with what else is installed, and with what ran before.
TEST(SharedLibraries, DoNotChangeWithWhatIsOpenedOnTheWay) {
  const std::string before = SharedLibraries();
  ASSERT_FALSE(HasLibrary(before, "libresolv.so"));
  void* const opened = dlopen("libresolv.so.2", RTLD_NOW);
  ASSERT_NE(opened, nullptr) << "a part of the C library";
  EXPECT_EQ(SharedLibraries(), before);
  dlclose(opened);
}

}  // namespace
}  // namespace dapple
