// Which planted bug is on. kill_matrix writes uses of this into its copy of the sources.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iterator>
#include <type_traits>

#include "property_tests/mutants/switch_names.hpp"  // kNames, which kill_matrix makes from mutants.txt

namespace sipplab_mutants {

inline constexpr int kCount = std::size(kNames);

inline unsigned char unheard[kCount];
/// For each mutant whether its code was reached; shared with all other processes of a test.
inline unsigned char* reached = unheard;

/// The number of the mutant that is named in SIPPLAB_MUTANT, or -1.
inline int choose() {
  if (const char* path = std::getenv("SIPPLAB_MUTANTS_REACHED")) {  // a file of kCount bytes
    const int file = ::open(path, O_RDWR | O_CLOEXEC);
    void* bytes =
        file < 0 ? MAP_FAILED : ::mmap(nullptr, kCount, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (file >= 0) ::close(file);
    if (bytes != MAP_FAILED) reached = static_cast<unsigned char*>(bytes);
  }
  const char* name = std::getenv("SIPPLAB_MUTANT");
  for (int number = 0; name && number < kCount; ++number) {
    if (std::strcmp(name, kNames[number]) == 0) return number;
  }
  return -1;
}
inline const int chosen = choose();

/// For constants, which are chosen when a program begins.
inline bool is_chosen(int number) {
  reached[number] = 1;
  return chosen == number;
}

/// What compilers compute has no bug.
constexpr bool is_on(int number) {
  if (std::is_constant_evaluated()) return false;
  return is_chosen(number);
}

}  // namespace sipplab_mutants
