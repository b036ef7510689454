#pragma once

/// Names and ids alone, for headers of yours that hold a world or a machine by pointer or by reference. It takes a
/// compiler a tenth of a second.
///
///     #include <dem/fwd.hpp>
///     struct Sand;  // a model, defined where the world is
///     void rake(dem::World<Sand>& world, dem::BodyId blade);

#include <dem/core/ids.hpp>

namespace dem {

struct Error;
struct Model;
struct StepReport;
struct WorldOptions;
struct SpeciesOptions;
struct SurfaceOptions;
struct NewGrain;
template <class Model>
class World;
template <class Model>
struct WorldState;

namespace mbd {
class Mechanism;
struct MachineReport;
struct BodySpec;
struct JointSpec;
struct Parts;
}  // namespace mbd

}  // namespace dem
