// The planted bugs of mutants/ still fit the sources: the text that each replaces is
// there exactly once. A stale table would claim kills that never happened.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Mutant {
  std::string name;
  std::string file;
  std::string harm;
  std::string before;
  std::string after;
};

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void append_line(std::string& text, const std::string& line) {
  if (!text.empty()) text += '\n';
  text += line;
}

/// mutants.txt says at its top what a mutant looks like.
std::vector<Mutant> read_mutants(const std::string& path) {
  std::vector<Mutant> mutants;
  std::istringstream lines(read_text(path));
  for (std::string line; std::getline(lines, line);) {
    if (line.substr(0, 1) == "[") {
      mutants.push_back({line.substr(1, line.size() - 2), {}, {}, {}, {}});
    } else if (mutants.empty() || line.substr(0, 1) == "#") {
      continue;
    } else if (line.substr(0, 5) == "room ") {
      std::istringstream words(line);
      std::string word;
      words >> word >> word >> word >> mutants.back().file;
    } else if (line.substr(0, 5) == "harm ") {
      mutants.back().harm = line.substr(5);
    } else if (line.substr(0, 2) == "- ") {
      append_line(mutants.back().before, line.substr(2));
    } else if (line.substr(0, 2) == "+ ") {
      append_line(mutants.back().after, line.substr(2));
    }
  }
  return mutants;
}

std::size_t occurrences(const std::string& text, const std::string& wanted) {
  std::size_t count = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos;
       at = text.find(wanted, at + wanted.size())) {
    ++count;
  }
  return count;
}

TEST(Mutants, TextIsFoundExactlyOnce) {
  const std::string root = SIPPLAB_SOURCE_DIR;
  const std::vector<Mutant> mutants = read_mutants(root + "/property_tests/mutants/mutants.txt");
  EXPECT_GE(mutants.size(), 100u);
  std::set<std::string> names;
  for (const Mutant& mutant : mutants) {
    EXPECT_TRUE(names.insert(mutant.name).second) << mutant.name << ": two mutants of this name";
    EXPECT_FALSE(mutant.harm.empty()) << mutant.name;
    EXPECT_NE(mutant.before, mutant.after) << mutant.name;
    ASSERT_FALSE(mutant.before.empty()) << mutant.name;
    EXPECT_EQ(occurrences(read_text(root + "/" + mutant.file), mutant.before), 1u)
        << mutant.name << " in " << mutant.file;
  }
}

}  // namespace
