#pragma once

/// For programs whose model has `using Executor = dem::exec::Flat`: the step of GPUs, on this processor.

#include <dem/flat/step.hpp>
#include <dem/parallel/flat.hpp>
#include <dem/world/world.hpp>
