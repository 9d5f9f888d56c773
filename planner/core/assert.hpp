// PLANNER_ASSERT(condition): an invariant of ours, never a check of input. Alive
// in debug, property and fuzz builds (SIPPLAB_ASSERTIONS), free elsewhere.
#pragma once

#ifdef SIPPLAB_ASSERTIONS
#include <cstdio>
#include <cstdlib>
#define PLANNER_ASSERT(condition)                                                            \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: broken invariant: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#else
#define PLANNER_ASSERT(condition) static_cast<void>(0)
#endif
