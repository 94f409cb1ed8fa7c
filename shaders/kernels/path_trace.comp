// A lane a pixel: resumes its path, works through the window's samples within the loop budget, saves.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
layout(local_size_x = 64) in;

#include "integrator/path_kernel.glsl"

void main() {
    uint lane = laneIndex();
    if (lane >= arguments.laneCount) return;
    tracePixel(lane);
}
