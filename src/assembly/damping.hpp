#pragma once
// What damping does to the linearised packing. The integrator takes the force of dashpots and of mass damping from the
// velocity half a step back, M(x₊ − 2x + x₋) = −Δt² K x − Δt C (x − x₋), which is stable exactly while
// 4M − 2Δt C − Δt² K is positive definite (docs/damping.md).
#include "assembly/network.hpp"
#include "state/scene.hpp"

namespace eg {

/// The contact dashpots as a network of their own: `normal` and `tangential` of a spring are 2ξn √(m* kn) and
/// 2ξs √(m* kt) [N s/m], m* = 1/(1/m_i + 1/m_j), all contacts sticking. C = Bᵀ diag(c) B with the B of K; mass damping
/// is not part of it.
Network dashpots(const Network& network, const DampingSpec& damping);

/// (1 + α)(K + 2C/Δt) as a network: the springs that the mode that flips at every step feels, α from local damping
/// (which then adds to every force), C from the dashpots. With c the mass damping, that mode is neutral at
/// Δt² λmax + 2c Δt = 4. `step`: Δt [s], > 0.
/// `inverse_mass`: 1/m_i + 1/m_j [1/kg].
Spring damped_spring(Spring spring, double inverse_mass, const DampingSpec& damping, double step);
Network damped_network(const Network& network, const DampingSpec& damping, double step);

}  // namespace eg
