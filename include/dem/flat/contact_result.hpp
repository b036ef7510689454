#pragma once

#include <dem/flat/histories_view.hpp>
#include <dem/grain/contact_wrench.hpp>
#include <dem/grain/materials.hpp>
#include <dem/grain/partner_view.hpp>

#include <cstddef>
#include <cstdint>

namespace dem::flat {

/// What a contact does: on its grain i, and on its partner.
struct alignas(16) ContactResult {
  Vector3<double> force;               ///< N, on i; the partner feels the opposite
  Vector3<double> torque_i, torque_j;  ///< N m, each about its own centre
  double overlap;                      ///< in effective diameters
};

/// The laws of the contacts: a table of constants, and which of them two partners have.
template <class Model>
struct LawsView {
  const ContactParameters<Model>* table;
  const std::uint32_t* rows;  ///< of the table: for each partner, one for each species
  std::size_t species;
  double time_step;  ///< s

  /// By bytes: for a struct whose empty members take no memory, nvcc 13.0 takes twice its size as the step of an array.
  DEM_FN const ContactParameters<Model>& of(std::size_t partner, std::size_t kind) const {
    const std::size_t at = rows[partner * species + kind] * sizeof(ContactParameters<Model>);
    return *reinterpret_cast<const ContactParameters<Model>*>(reinterpret_cast<const unsigned char*>(table) + at);
  }
};

DEM_FN grain::RelativeMotion<double> relative_motion(const PartnerView& i, const PartnerView& j) {
  return {j.position - i.position, i.velocity - j.velocity, i.angular_velocity, j.angular_velocity,
          i.inverse_mass + j.inverse_mass};
}

/// The laws for one contact, whose history is brought up to date.
template <class Model, class ContactPoint>
DEM_FN ContactResult evaluate_contact(const ContactPoint& point, const PartnerView& i, const PartnerView& j,
                                      const ContactParameters<Model>& parameters, double time_step,
                                      ContactHistory<Model, double>& history) {
  double overlap = 0.0;
  const grain::PairWrench<double> w =
      grain::contact_wrench<Model, double>(point, relative_motion(i, j), parameters, time_step, history, overlap);
  return {w.force, w.torque_i, w.torque_j, overlap};
}

}  // namespace dem::flat
