#pragma once
// Which way contacts point and forces go. Contacts with walls are left out: their directions are the walls' own.
#include <array>
#include <span>

#include "state/gather.hpp"

namespace eg {

/// Fabric tensor Φ = (1/Nc) Σ n⊗n (Satake 1982); zero without contacts. Its trace is 1.
Mat3 fabric_tensor(std::span<const ContactPoint>);

/// Force-fabric tensor Σ N n⊗n/Σ N: every contact counts by its normal force N (the weighting of Radjai et al. 1998).
/// Its trace is 1; zero without force.
Mat3 force_fabric_tensor(std::span<const ContactPoint>);

/// σ^N = (1/V) Σ N n⊗l and σ^T, the rest: what normal and tangential forces give to the stress, compression positive
/// [Pa] (Thornton and Antony 1998).
struct StressParts {
  Mat3 normal, tangential;
};
StressParts stress_parts(std::span<const ContactPoint>, double volume);

}  // namespace eg
