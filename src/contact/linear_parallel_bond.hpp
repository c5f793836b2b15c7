#pragma once
// Linear contacts with parallel bonds (Potyondy and Cundall 2004): a disk of cement between two grains that carries
// tension, shear, bending and twisting until it breaks.
#include "contact/linear.hpp"

namespace eg {

/// Contact forces as Linear; beside them, while the bond holds, with k̄n = Ē/L, k̄s = k̄n/κ̄, R̄ = λ min(R1, R2):
/// F̄n = k̄n A (δ − δ0), F̄s += k̄s A Δs, M̄b += k̄n I Δθ across n, M̄t += k̄s J Δθ along n, δ0 the overlap when the bond
/// was made. A = πR̄², I = πR̄⁴/4, J = 2I; 2D, unit thickness: A = 2R̄, I = 2R̄³/3. It breaks, and its forces vanish,
/// when σ = −F̄n/A + β|M̄b|R̄/I > σc or τ = |F̄s|/A + β|M̄t|R̄/J > τc. Two materials: the smaller strength.
struct LinearParallelBond {
  static constexpr std::string_view name = "linear-parallel-bond";
  static constexpr std::size_t history_vectors = 3, history_scalars = 3;  // T, F̄s, M̄b; bond (1: holds), δ0, M̄t
  static constexpr bool couples = true;
  static constexpr std::size_t bond_value = 9;  ///< place of the value that is > 0 while the bond holds

  static std::vector<ConstantSet> constant_sets() { return Linear::constant_sets(); }
  static ConstantSet further_constants() {
    return {{"bond_modulus", &Material::bond_modulus},
            {"bond_stiffness_ratio", &Material::bond_stiffness_ratio},
            {"bond_radius_ratio", &Material::bond_radius_ratio},
            {"bond_moment_share", &Material::bond_moment_share},
            {"bond_tensile_strength", &Material::bond_tensile_strength},
            {"bond_shear_strength", &Material::bond_shear_strength}};
  }

  template <class S>
  struct Constants {
    Linear::Constants<S> linear;
    S modulus, softer;     ///< Ē [Pa], 1/κ̄ [-]
    S radius, share;       ///< λ, β [-]
    S tensile, shear;      ///< σc, τc [Pa]
    S area3, area2;        ///< A = (area2 + area3 R̄) R̄
    S inertia3, inertia2;  ///< I = (inertia2 + inertia3 R̄) R̄³
  };
  template <class S>
  struct Pair : Linear::Pair<S> {
    S axial, across;      ///< k̄n A, k̄s A [N/m]
    S bending, twisting;  ///< k̄n I, k̄s J [N m]
    S area, bend, twist;  ///< 1/A [1/m²], βR̄/I and βR̄/J [1/m³]
    S tensile, strength;  ///< σc, τc [Pa]
  };

  static Constants<double> constants(const Material& a, const Material& b, int dimension) {
    const auto series = [](double x, double y) { return 2 * x * y / (x + y); };
    const auto mean = [](double x, double y) { return (x + y) / 2; };
    const bool solid = dimension == 3;
    using std::numbers::pi;
    return {Linear::constants(a, b, dimension),
            series(a.bond_modulus, b.bond_modulus),
            1 / mean(a.bond_stiffness_ratio, b.bond_stiffness_ratio),
            mean(a.bond_radius_ratio, b.bond_radius_ratio),
            mean(a.bond_moment_share, b.bond_moment_share),
            std::min(a.bond_tensile_strength, b.bond_tensile_strength),
            std::min(a.bond_shear_strength, b.bond_shear_strength),
            solid ? pi : 0.0,
            solid ? 0.0 : 2.0,
            solid ? pi / 4 : 0.0,
            solid ? 0.0 : 2.0 / 3};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    const S r = c.radius * sizes.smaller, kn = c.modulus * reciprocal(sizes.length), ks = kn * c.softer;
    const S area = (c.area2 + c.area3 * r) * r, inertia = (c.inertia2 + c.inertia3 * r) * r * r * r;
    const S bend = c.share * r * reciprocal(inertia);
    return {Linear::pair<S>(c.linear, sizes),
            kn * area,
            ks * area,
            kn * inertia,
            S(2.0) * ks * inertia,
            reciprocal(area),
            bend,
            S(0.5) * bend,
            c.tensile,
            c.shear};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    return Linear::normal<S>(p, overlap);
  }
  static double normal_energy(const Pair<double>& p, double overlap) { return Linear::normal_energy(p, overlap); }

  /// Makes a bond at the present overlap δ [m] (< 0: a gap).
  static void bond(std::array<double, 12>& h, double overlap) {
    set_history_vector(h, 1, Vec3{}), set_history_vector(h, 2, Vec3{});
    h[bond_value] = 1, h[10] = overlap, h[11] = 0;
  }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 12>& h) {
    const Vec<S> shear_before = history_vector(h, 0), bond_before = history_vector(h, 1),
                 bend_before = history_vector(h, 2);
    const S twist_before = h[11], zero(0.0);
    auto n = normal<S>(p, strain.overlap);
    Response<S> r = cumulative_shear(n, p.friction, strain.slip, h);
    add_spring_work(r, shear_before, r.shear, r.unslipped, n.tangential, strain.slip);

    const auto bonded = h[bond_value] > zero;
    const S pressed = select(bonded, p.axial * (strain.opening - h[10]), zero);
    const Vec<S> sheared = select(bonded, bond_before + strain.slip * p.across, bond_before);
    const Vec<S> bent = select(bonded, bend_before + strain.roll * p.bending, bend_before);
    const S twisted = select(bonded, twist_before + strain.twist * p.twisting, zero);
    const S tension = p.bend * root(dot(bent, bent)) - p.area * pressed;
    const S shearing = p.area * root(dot(sheared, sheared)) + p.twist * max(twisted, -twisted);
    const auto pulled = bonded & (tension > p.tensile);
    const auto cut = bonded & !(tension > p.tensile) & (shearing > p.strength);
    const auto holds = bonded & !(tension > p.tensile) & !(shearing > p.strength);
    r.pulled = select(pulled, S(1.0), zero), r.cut = select(cut, S(1.0), zero);

    const Vec<S> none{zero, zero, zero};
    const Vec<S> shear = select(holds, sheared, none), bend = select(holds, bent, none);
    const S twist = select(holds, twisted, zero);
    add_spring_work(r, bond_before, shear, sheared, p.across, strain.slip);
    add_spring_work(r, bend_before, bend, bent, p.bending, strain.roll);
    const Vec<S> along{strain.twist, zero, zero};
    add_spring_work(r, Vec<S>{twist_before, zero, zero}, Vec<S>{twist, zero, zero}, Vec<S>{twisted, zero, zero},
                    p.twisting, along);
    const S snapped = select(holds, zero, S(0.5) * pressed * pressed / p.axial);  // the axial spring has a potential
    r.work = r.work + snapped, r.loss = r.loss + snapped;

    set_history_vector(h, 1, shear), set_history_vector(h, 2, bend);
    h[bond_value] = select(holds, h[bond_value], zero), h[10] = select(holds, h[10], zero), h[11] = twist;
    const auto touching = strain.opening > zero;
    r.normal = {n.force + select(holds, pressed, zero),
                select(touching, n.stiffness, zero) + select(holds, p.axial, zero),
                select(touching, n.tangential, zero) + select(holds, p.across, zero)};
    r.shear += shear, r.unslipped += shear;
    r.couple = bend, r.torsion = twist;
    return r;
  }

  template <class S>
  EG_INLINE static Held<S> held(const std::array<S, 12>& h) {
    return {history_vector(h, 0) + history_vector(h, 1), history_vector(h, 2), h[11]};
  }

  static Standing at_rest(const Pair<double>& p, double overlap, const std::array<double, 12>& h) {
    Standing s;
    if (overlap > 0) s = standing_springs<LinearParallelBond>(p, overlap, history_vector(h, 0));
    if (!(h[bond_value] > 0)) return s;
    const Vec3 shear = history_vector(h, 1), bend = history_vector(h, 2);
    const double pressed = p.axial * (overlap - h[10]);
    s.normal.force += pressed, s.normal.stiffness += p.axial, s.normal.tangential += p.across;
    s.rolling = p.bending, s.twisting = p.twisting;
    s.shear += shear, s.bonded = true;
    s.normal_energy += pressed * pressed / (2 * p.axial);
    s.shear_energy +=
        dot(shear, shear) / (2 * p.across) + dot(bend, bend) / (2 * p.bending) + h[11] * h[11] / (2 * p.twisting);
    return s;
  }
};
static_assert(ContactLaw<LinearParallelBond> && HasBonds<LinearParallelBond>);

}  // namespace eg
