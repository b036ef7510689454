#include "worlds.hpp"

TEST_MACHINE(, dem::integrator::PredictorCorrector)
TEST_MACHINE(, dem::integrator::SymplecticEuler)
TEST_MACHINE(, dem::integrator::VelocityVerlet)
