// Values as text; see shown.hpp.
#include "property_tests/support/shown.hpp"

#include "sipplab/instance_io.hpp"

namespace sipplab {

std::ostream& operator<<(std::ostream& out, const Instance& instance) {
  return out << write_instance_xml(instance);
}

std::ostream& operator<<(std::ostream& out, const GridMap& map) { return out << write_movingai_map(map); }

std::ostream& operator<<(std::ostream& out, const OpenInterval& span) {
  return out << "(" << span.begin_s << ", " << span.end_s << ")";
}

std::ostream& operator<<(std::ostream& out, Fraction fraction) {
  return out << fraction.numerator << "/" << fraction.denominator;
}

void showValue(const Objective& objective, std::ostream& out) { out << format_objective(objective); }

void showValue(const LinearMotion& motion, std::ostream& out) {
  const Vec2 v = motion.velocity_cells_per_s;
  out << "from (" << motion.from.x << ", " << motion.from.y << ") at " << motion.begin_s << " to "
      << motion.end_s << " s, (" << v.x << ", " << v.y << ") a second";
}

}  // namespace sipplab
