#pragma once

/// Everything of the multibody dynamics layer.

#include <dem/mbd/energy.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/mbd/recorder.hpp>
