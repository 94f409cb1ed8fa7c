#include "app/compare_command.h"

namespace parhelion::app {

namespace {

constexpr double kMax = 1e300;

void addLimits(Command& command, CompareArguments& arguments) {
    addNumberOption(command, "--max-mse", arguments.maxMse, 0, kMax, "fail above this mean squared error");
    addNumberOption(command, "--max-mae", arguments.maxMae, 0, kMax, "fail above this mean absolute error");
    addNumberOption(command, "--max-error", arguments.maxError, 0, kMax, "fail above this largest absolute error");
    addNumberOption(command, "--max-relmse", arguments.maxRelativeMse, 0, kMax,
                    "fail above this mean of (A - B)^2 / (B^2 + epsilon)");
    addNumberOption(command, "--max-mean-difference", arguments.maxMeanDifference, 0, kMax,
                    "fail when a channel's mean(A) / mean(B) is further than this from 1");
    addNumberOption(command, "--mean-within", arguments.meanWithin, 0, kMax,
                    "fail unless the 95 % interval of every channel's mean(A) / mean(B) lies this close to 1");
    command.addFlag("--noise-alone", arguments.requireNoiseAlone,
                    "fail when the mean squared error is above what the variance channels add up to; less passes, as "
                    "of renders with the same random numbers");
    command.addFlag("--independent-noise", arguments.requireIndependentNoise,
                    "fail when it is above or below: independent renders with unbiased variances");
    command.addFlag("--agree", arguments.requireAgreement,
                    "fail unless the images agree within their noise (their variance channels), or are equal");
}

}  // namespace

Command addCompareCommand(CommandLine& program, CompareArguments& arguments) {
    Command command = program.addCommand("compare", "Measure how image A differs from image B");
    command.addArgument("A", arguments.imageA, "image (.exr)");
    command.addArgument("B", arguments.imageB, "image to measure against (.exr)");
    addTextOption(command, "--error", arguments.error, "FILE",
                  "write the differences to this .exr; beside it a .png of |A - B|, 1 being the mean of B");
    addTextOption(command, "--pictures", arguments.pictures, "PREFIX",
                  "write PREFIX_a.png, PREFIX_b.png, PREFIX_error.png (A - B, mean of the channels: red above, blue "
                  "below; full colour at a tenth of the mean of B) and, with noise estimates, PREFIX_z.png (full "
                  "colour at 4 deviations)");
    addNumberOption(command, "--error-range", arguments.errorRange, 1e-30, kMax,
                    "error of full colour in PREFIX_error.png");
    addLimits(command, arguments);
    command.addFlag("--json", arguments.json,
                    "print as JSON, null for what is not finite; `verdict` is identical, agree, lessNoise, moreNoise, "
                    "differ, noiseUnknown or notFinite");
    command.setFooter(
        "Examples:\n"
        "  parhelion compare cloud.exr oracle.exr\n"
        "  parhelion compare cloud.exr oracle.exr --agree --error difference.exr\n"
        "  parhelion compare cloud.exr oracle.exr --max-relmse 0.01 --max-mean-difference 0.002\n\n"
        "The first line is the verdict: identical; agree; less noise than independent renders would have;\n"
        "MORE THAN NOISE; DIFFERENT; different, noise unknown; or NOT FINITE. Only limits decide the exit\n"
        "code. Identical images pass all of them but --independent-noise; no limit is passed with a value\n"
        "that is not finite.\n"
        "Exit codes: 0 within every limit given, or none given; 1 beyond one; 2 bad input (a file that is\n"
        "no image, another size, a missing channel, a negative variance); 3 memory; 130 interrupted.");
    return command;
}

}  // namespace parhelion::app
