// Every tolerance of the planner and of its validator, in one place, with its
// unit and the error that it covers. Nothing else in the project compares
// floating-point numbers "nearly".
#pragma once

namespace sipplab {

/// Cells. Overlap of two bodies that counts as touching, which is allowed.
/// Exact touches are everywhere on a grid, and rounding makes the computed
/// distance of such a pair fall short by up to 2e-13 cells; the shallowest true
/// overlap of two disks of radius 0.5 that move between cell centres of a map
/// of 1,000 x 1,000 cells is deeper than 1e-7 cells.
inline constexpr double kTouchDepthCells = 1e-9;

/// Cells. How far two bodies may be taken to have moved apart when the end of a
/// collision interval is a contact: the interval shrinks by this much divided by
/// the faster speed. Without it a gap of zero width between two robots that
/// follow each other in contact would be lost in rounding (errors of a few 1e-13 s
/// at times near 1e3 s). Each of two robots gives way once, so overlaps of up to
/// twice this value can occur in a plan.
inline constexpr double kContactSlackCells = 1e-9;

/// Cells. Overlap that the validator accepts. Looser than what the planner
/// allows (2 * kContactSlackCells) so that a correct plan is never
/// called invalid, and far below any overlap that a planning error can produce.
inline constexpr double kValidatorToleranceCells = 1e-8;

/// Seconds, relative to max(1, time). Difference between the duration of a
/// motion and its length divided by the robot's speed that rounding explains.
inline constexpr double kDurationTolerance = 1e-9;

/// Degrees. Difference between a stated heading and the direction of the move after it
/// that rounding explains; so small a turn takes less than 1e-9 s even at the slowest
/// rotation speed.
inline constexpr double kHeadingToleranceDeg = 1e-10;

}  // namespace sipplab
