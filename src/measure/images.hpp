#pragma once
// Periodic images of a point, as many as reach some place.
#include <functional>

#include "state/cell.hpp"

namespace eg {

/// Calls visit with every translation by whole edges of the cell that brings a point within `reach` [m] of the centre
/// (and perhaps a few that do not); without periodic directions once, with zero.
void visit_images(const Cell& cell, const Vec3& point, const Vec3& centre, double reach,
                  const std::function<void(const Vec3& shift)>& visit);

}  // namespace eg
