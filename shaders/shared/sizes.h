// How many of each the scene has, where loops should be unrolled over them: specialisation constants,
// so that uniform-block loads get constant offsets. X(identifier, constant id). Ids start at 96.
#ifndef PARHELION_SHARED_SIZES_H
#define PARHELION_SHARED_SIZES_H

#define PARHELION_SIZES(X) \
    X(quadCount, 96)       \
    X(sphereCount, 97)     \
    X(boxCount, 98)        \
    X(shapeCount, 99)

#endif
