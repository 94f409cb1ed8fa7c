// What a user chooses to pay for. X(identifier, specialisation constant id, type, default, label).
// Ids start at 64, clear of the effects.
#ifndef PARHELION_SHARED_QUALITY_H
#define PARHELION_SHARED_QUALITY_H

#define PARHELION_QUALITY(X)                                                                     \
    X(stepsPerEvent, 64, uint, 4u, "tracking steps between two event evaluations (speed only)")  \
    X(shadowRoulette, 65, float, 3.0f, "shadow-ray roulette threshold, relative to 4 pi times the scattering value") \
    X(stochasticFilter, 66, bool, true, "density from one randomly chosen corner instead of eight") \
    X(sobol, 68, bool, true, "Owen-scrambled Sobol points for film, directions, lights and flights instead of independent ones")

#endif
