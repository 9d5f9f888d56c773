// The properties of one room: `properties ROOM`.
#include "property_tests/support/property.hpp"

int main(int argc, char** argv) { return sipplab::run_room({argv + 1, argv + argc}); }
