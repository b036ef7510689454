#pragma once

/// Everything of the multibody dynamics layer, with the integrators that a machine names.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/mbd/sensor/energy.hpp>
#include <dem/mbd/sensor/energy_balance.hpp>
#include <dem/mbd/sensor/recorder.hpp>
