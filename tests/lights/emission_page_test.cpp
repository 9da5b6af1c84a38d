// Pages of docs say which test shows what: every test that they name is there, and the table of faults in emission.md
// is the one that the mutation suite checks.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/lights/mutants.h"

namespace dapple {
namespace {

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::filesystem::path kSource = DAPPLE_SOURCE_DIR;

/// "Suite.Name" of all tests of the project.
std::set<std::string> AllTests() {
  const std::regex test(R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = TextOf(entry.path());
    for (std::sregex_iterator i(text.begin(), text.end(), test), end; i != end; ++i)
      names.insert((*i)[1].str() + "." + (*i)[2].str());
  }
  return names;
}

/// The part of the page about properties and their tests.
std::string Section() {
  const std::string page = TextOf(kSource / "docs" / "emission.md");
  const size_t begin = page.find("## Properties and their tests");
  EXPECT_NE(begin, std::string::npos);
  return page.substr(begin, page.find("\n## ", begin) - begin);
}

TEST(EmissionPage, NamesTestsThatAreThere) {
  const std::set<std::string> tests = AllTests();
  const std::regex name(R"(`(\w+\.\w+)`)");
  for (const auto& [page, atLeast] : {std::pair("emission.md", 150), {"environment.md", 5}}) {
    const std::string text = TextOf(kSource / "docs" / page);
    int count = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end; ++i, ++count)
      EXPECT_TRUE(tests.count((*i)[1].str()) > 0) << page << ": " << (*i)[1].str();
    EXPECT_GE(count, atLeast) << page;
  }
}

// That page abbreviates suites by a letter, and names by their beginning and "...".
TEST(MaterialsPage, NamesTestsThatAreThere) {
  const std::set<std::string> tests = AllTests();
  const std::map<std::string, std::string> suites = {{"N", "NonSpecularBsdf"},
                                                     {"F", "NonSpecularFurnace"},
                                                     {"S", "SpecularBsdf"},
                                                     {"R", "BsdfRho"},
                                                     {"M", "Microfacets"}};
  const std::regex name(R"(\b([A-Z]\w*)\.([A-Z]\w+)(\.\.\.)?)");
  const std::string text = TextOf(kSource / "docs" / "materials.md");
  int count = 0;
  for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end; ++i, ++count) {
    const auto suite = suites.find((*i)[1].str());
    const std::string test = (suite == suites.end() ? (*i)[1].str() : suite->second) + "." + (*i)[2].str();
    const auto found = tests.lower_bound(test);
    EXPECT_TRUE(found != tests.end() && ((*i)[3].matched ? found->starts_with(test) : *found == test)) << (*i).str();
  }
  EXPECT_GE(count, 60);
}

TEST(EmissionPage, HasNoEmptyCell) {
  std::istringstream lines(Section());
  const std::regex empty(R"(\|\s*\|)");
  for (std::string line; std::getline(lines, line);) {
    EXPECT_FALSE(line.starts_with("|") && std::regex_search(line, empty)) << line;
  }
}

TEST(EmissionPage, ListsTheFaultsThatAreRejected) {
  const std::string section = Section();
  for (const Fault& fault : AllFaults()) {
    const std::string row = "| " + fault.name + " | " + fault.rejectedBy[0] + " | " + fault.rejectedBy[1] + " | " +
                            fault.rejectedBy[2] + " |";
    EXPECT_NE(section.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace dapple
