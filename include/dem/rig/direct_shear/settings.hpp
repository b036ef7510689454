#pragma once

#include <dem/soil/relative_density.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::direct_shear {

/// What a kind of grain is called, and the defaults that suit it.
struct GrainKind {
  std::string name = {};                            ///< one word: of --shape and of packing files
  std::string plural = "grains";                    ///< for the report
  double stiffness = 2e4;                           ///< K, N/m, of what grains_of() makes
  double damping = 0.015;                           ///< C, N s/m, likewise
  double relative_density = 0.0;                    ///< of a packing
  double strike_off = 0.0;                          ///< share of the highest grains that are taken off
  soil::DensityLimits limits = soil::cube8_limits;  ///< that relative densities are counted between
};

/// Everything that can be chosen. A value of 0 where it says "0: by size" is filled in by resolve(). Units: SI, as
/// given on the command line too, except where a name says otherwise.
struct Settings {
  std::string size = "quick";  ///< smoke, quick or full

  /// Of the cubical grains: cube8 (eight spheres), polyhedron (sharp edges), superquadric (rounded).
  std::string shape = "cube8";
  std::optional<GrainKind> own_kind = {};  ///< of grains of your own; `shape` then says nothing

  // Specimen and box (thesis section 3.2: 60 x 60 x 50 mm, 14,256 cubes of half-edge 0.9 mm)
  double half_edge = 0.0;       ///< m, half the edge of the cube that a grain fills about; 0: by size
  std::uint64_t grains = 0;     ///< 0: as many as fill the box as high as 14,256 of half-edge 0.9 mm do
  double box_length = 0.06;     ///< m, along the shearing direction
  double box_width = 0.06;      ///< m
  double box_height = 0.05;     ///< m
  double seam_height = 0.0;     ///< m, where the halves meet; 0: half the specimen's height
  double wall_thickness = 0.0;  ///< m, at least the travel; 0: 15 mm or twice the travel, whichever is more
  double lid_clearance = 0.25;  ///< of lid and walls, in radii of a grain's sphere; below 1

  // Contacts (thesis table 3.2 and figure 3.6) of a grain of half-edge `constants_for`. By shape: the thesis's 20,000
  // N/m and 0.015 N s/m for each sphere of cube8, of which four touch where a face lies on a face; four times that for
  // the other shapes, whose faces touch once.
  double stiffness = 0.0;            ///< K, N/m: the screenshots' value; the tables' 2000 is too soft
                                     ///< (examples/direct_shear/RESULTS.md); 0: by shape
  double damping = -1.0;             ///< C, N s/m; negative: by shape
  double separation_factor = 0.05;   ///< Sp
  double friction = 0.4;             ///< mu, grain on grain
  double wall_friction = -1.0;       ///< mu, grain on wall; negative: as grain on grain
  double friction_stiffness = -1.0;  ///< kt, N/m; negative: as K
  double velocity_stiffness = -1.0;  ///< cv, N s/m; negative: as C
  double breaking_factor = 0.975;    ///< share of the friction that a broken asperity keeps
  double density = 2650.0;           ///< kg/m^3, of a grain
  double constants_for = 0.9e-3;     ///< m
  bool scale_contacts = true;        ///< K, kt ~ size and C, cv ~ size^2: see contact_scale()

  // Packing
  std::string packing = "random";  ///< random or poured
  double relative_density = -1.0;  ///< of a random packing; 0: as it settles; negative: by shape
  double tilt_deg = 10.0;          ///< of a poured block, about each axis
  double shake_amplitude = 2e-4;   ///< m
  double shake_frequency = 25.0;   ///< Hz
  double shake_time = 0.2;         ///< s, of a poured packing
  double densify_time = 0.5;       ///< s, in which friction goes from full to none while a random packing is shaken
  double strike_off = -1.0;   ///< share of a packing's grains, the highest, taken away; 0: none; negative: by shape
  double settle_limit = 3.0;  ///< s; a packing that is not at rest by then ends the run
  std::string packing_file;   ///< read instead of made
  std::string save_packing;   ///< empty: <output>/packing.txt
  bool packing_only = false;  ///< make, measure and save the packing; no test

  // Test
  std::vector<double> loads;         ///< kg, on the lid; empty: by size
  double lid_speed = 0.1;            ///< m/s, at which the lid is lowered before it meets the grains
  double rest_speed = 2e-4;          ///< m/s, below which the lid is at rest
  double consolidation_limit = 2.0;  ///< s
  double shear_speed = 0.0;          ///< m/s; 0: by size
  double travel = 0.0;               ///< m; 0: by size
  double ramp_time = 0.02;           ///< s, of the smooth start
  double smoothing = 1.5e-4;         ///< m of travel, over which the stress is averaged before its maximum is taken
  double residual_share = 0.25;      ///< last share of the travel, over which the residual stress is averaged
  bool area_correction = false;      ///< stresses over the shrinking area of contact of the halves, not the nominal one

  // Numerics
  std::string integrator = "verlet";      ///< the thesis's predictor-corrector takes twice the time
  double time_step = 0.0;                 ///< s; 0: a share of the largest stable one
  double stable_share = 0.8;              ///< the share; grains are poured at 0.8 in any case
  bool allow_unstable_time_step = false;  ///< accept a `time_step` above the largest stable one
  /// Overlap that ends the run, in effective diameters 2 Ri Rj/(Ri + Rj): in radii where two equal spheres touch, in
  /// diameters where a sphere touches a wall. K = 2000 N/m is soft: force chains press spheres half a radius together.
  double overlap_limit = 1.0;
  std::uint64_t seed = 1;  ///< of a random packing
  int threads = 0;         ///< 0: all, but not more than one for each 1000 grains

  // Output
  std::string output = "direct_shear_output";
  bool replay = true;                  ///< of the load in the middle, in the report
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of the replay, the largest; 0: none
  bool vtk = true;
  bool vtk_spheres = false;   ///< also the eight spheres of each grain
  double vtk_interval = 0.0;  ///< m of travel between two frames; 0: a twentieth of the travel

  /// m^2, that a force on the plane of shear is divided by once the halves are `displacement` (m) apart.
  double area(double displacement = 0.0) const {
    return (box_length - (area_correction ? displacement : 0.0)) * box_width;
  }
  /// Pa, of a mass (kg) on the lid: over the same area as the shear stress.
  double normal_stress(double load, double displacement = 0.0) const { return 9.81 * load / area(displacement); }
};

}  // namespace dem::rig::direct_shear
