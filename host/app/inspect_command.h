#pragma once

#include "app/options.h"

namespace parhelion::app {

struct InspectArguments {
    SceneArguments scene;
    bool json = false, bakeError = false;
};

Command addInspectCommand(CommandLine& program, InspectArguments& arguments);

/// Prints what a scene holds, what each array costs, and which effects are simulated, with the reason.
int runInspectCommand(const InspectArguments& arguments);

}  // namespace parhelion::app
