#pragma once

#include <dem/core/error.hpp>
#include <dem/rig/names_in.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace dem::rig::sand_pile {

/// Everything that can be chosen. A value of 0 where it says "0: by size" is filled in by resolve(). Units: SI, as
/// given on the command line too, except where a name says otherwise.
struct Settings {
  std::string size = "quick";   ///< smoke, quick or full
  std::string method = "lift";  ///< lift (a cylinder), funnel, or drain (a box, through a slot in its floor)
  std::string kinds;            ///< of grains, see kind_named(), with commas between them; empty: by size
  std::uint64_t seed = 1;       ///< of the first pile
  std::uint64_t seeds = 0;      ///< piles of each kind; 0: by size

  // Grains
  double half_edge = 0.0;    ///< m, of the cube that a grain's volume is about that of; 0: by size
  std::uint64_t grains = 0;  ///< 0: by size
  double density = 2650.0;   ///< kg/m^3
  std::string fill_file;     ///< grains at rest in their container, of an earlier run; empty: they are rained in

  // Apparatus
  std::string plate = "ridged";        ///< flat, or ridged: rings (of a box's floor: bars) a half-edge high
  double plate_radius = 0.0;           ///< m; 0: three times the cylinder's
  double cylinder_radius = 0.0;        ///< m; 0: the grains fill it twice as high as its radius
  double lift_speed = 0.05;            ///< m/s, the cylinder's largest
  double orifice_radius = 0.0;         ///< m, of the funnel; 0: seven half-edges
  double orifice_height = 0.0;         ///< m, of the funnel above the plate; 0: above a cone of 40 deg
  double funnel_angle_deg = 35.0;      ///< of the funnel's wall from the vertical
  double box_length = 0.0;             ///< m, of the floor that grains stay on; 0: from the number of grains
  double box_width = 0.0;              ///< m; 0: sixteen half-edges
  double slot_width = 0.0;             ///< m; 0: twelve half-edges
  double plate_friction = -1.0;        ///< mu of grains on plate or floor; negative: as grain on grain
  double container_friction = -1.0;    ///< mu of grains on cylinder and funnel (0 if negative), on a box's walls (as
                                       ///< the floor's if negative)
  double plate_rolling_length = -1.0;  ///< m, as rolling_length, on plate, floor and walls; negative: as among grains

  // Contacts (thesis table 3.2) of a grain of half-edge `constants_for`, for one sphere of a cube8; sharp and rounded
  // cubes, and spheres, touch once where a face of cube8 touches four times, and have four times K, kt, C and cv.
  double stiffness = 2000.0;         ///< K, N/m
  double damping = 0.015;            ///< C, N s/m
  double separation_factor = 0.05;   ///< Sp
  double friction = 0.4;             ///< mu, grain on grain
  double friction_stiffness = -1.0;  ///< kt of asperities, N/m; negative: as K
  double velocity_stiffness = -1.0;  ///< cv, N s/m; negative: as C
  double breaking_factor = 0.975;    ///< share of the friction that a broken asperity keeps
  double rolling_length = 0.0;       ///< m: rolling resists by this times the normal force; 0: a fifth of half_edge
  double rolling_damping = 0.3;      ///< of sphere-rolling: damping ratio of the springs that resist rolling
  double constants_for = 0.9e-3;     ///< m
  bool scale_contacts = true;        ///< K, kt ~ half-edge and C, cv ~ its square

  // Stages
  double settle_limit = 3.0;  ///< s; grains that are not at rest in their container by then end the run
  double rest_limit = 0.0;    ///< s; after which a pile that still moves is measured as it is; 0: by size
  double flow_limit = 10.0;   ///< s; funnel and box must be empty by then
  double creep_time = 0.0;    ///< s; 0: by size
  double sample_time = 0.01;  ///< s, between two samples, at which it is also seen whether grains rest

  // Fit
  double flank_low = 0.2, flank_high = 0.8;  ///< shares of the height: see soil::FlankOptions
  std::uint64_t directions = 12;             ///< of a heap; strips of a drained box: a third of it

  // Numerics
  double stable_share = 0.8;  ///< of the largest stable time step
  int threads = 0;            ///< of all piles; 0: all, but for a pile not more than one for each 1000 grains
  bool sleep = false;         ///< grains at rest may sleep until the pile is measured

  // Output
  std::string output = "sand_pile_output";
  bool replay = true;                  ///< of the first pile, in the report
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of the replay, the largest; 0: none
  bool vtk = true;
  double frame_time = 0.05;  ///< s, between two frames
};

/// m, of the sphere with the volume of a cube of that half-edge: the spheres that are piled up beside cubes.
inline double sphere_radius(double half_edge) { return half_edge * std::cbrt(6.0 / std::numbers::pi); }

/// A kind of grain: a shape, and which of the laws act.
struct Kind {
  std::string name;      ///< "cube8-viscous"
  std::string shape;     ///< cube8, polyhedron, superquadric or sphere
  bool viscous = false;  ///< Coulomb-viscous friction: asperities without a spring
  bool rolling = false;  ///< resistance against rolling, of spheres
  bool braked = false;   ///< that resistance is a constant torque, without a spring

  /// The world that makes it: that of its shape, or of another law of rolling.
  [[nodiscard]] std::string world() const { return braked ? shape + "-braked" : shape; }
};

/// The kind of that name: a shape, and behind it "-viscous" or, of spheres, "-rolling" or "-braked". Throws Error for
/// another name.
inline Kind kind_named(const std::string& name) {
  const auto dash = name.find('-');
  Kind kind = {.name = name, .shape = name.substr(0, dash)};
  const std::string law = dash == std::string::npos ? "" : name.substr(dash + 1);
  kind.viscous = law == "viscous";
  kind.braked = law == "braked" && kind.shape == "sphere";
  kind.rolling = kind.braked || (law == "rolling" && kind.shape == "sphere");
  const bool known =
      kind.shape == "cube8" || kind.shape == "polyhedron" || kind.shape == "superquadric" || kind.shape == "sphere";
  if (!known || (dash != std::string::npos && !kind.viscous && !kind.rolling)) {
    fail(
        "a kind of grain is '{}', but must be cube8, polyhedron, superquadric or sphere, any of them with '-viscous' "
        "behind it for friction without springs, or sphere-rolling, or sphere-braked",
        name);
  }
  return kind;
}

/// The kinds in a text with commas. Throws Error for an unknown kind, or one that stands there twice.
inline std::vector<Kind> kinds_in(const std::string& names) {
  std::vector<Kind> kinds;
  for (const std::string& name : names_in(names)) {
    kinds.push_back(kind_named(name));
    for (std::size_t k = 0; k + 1 < kinds.size(); ++k) {
      if (kinds[k].name == kinds.back().name) fail("--kinds names '{}' twice; leave one out", kinds[k].name);
    }
  }
  return kinds;
}

}  // namespace dem::rig::sand_pile
