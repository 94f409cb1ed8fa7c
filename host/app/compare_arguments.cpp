#include "app/compare_command.h"

namespace parhelion::app {

CLI::App* addCompareCommand(CLI::App& program, CompareArguments& arguments) {
    constexpr double kMax = 1e300;
    CLI::App* command = program.add_subcommand("compare", "Measure how image A differs from image B");
    command->add_option("A", arguments.imageA, "image (.exr)")->required()->type_name("");
    command->add_option("B", arguments.imageB, "image to measure against (.exr)")->required()->type_name("");
    command
        ->add_option("--error", arguments.error,
                     "write the differences to this .exr; beside it a .png of |A - B|, 1 being the mean of B")
        ->type_name("FILE");
    command
        ->add_option("--pictures", arguments.pictures,
                     "write PREFIX_a.png, PREFIX_b.png, PREFIX_error.png (A - B, mean of the channels: red above, blue "
                     "below; full colour at a tenth of the mean of B) and, with noise estimates, PREFIX_z.png (full "
                     "colour at 4 deviations)")
        ->type_name("PREFIX");
    addNumberOption(*command, "--error-range", arguments.errorRange, 1e-30, kMax,
                    "error of full colour in PREFIX_error.png");
    addNumberOption(*command, "--max-mse", arguments.maxMse, 0, kMax, "fail above this mean squared error");
    addNumberOption(*command, "--max-mae", arguments.maxMae, 0, kMax, "fail above this mean absolute error");
    addNumberOption(*command, "--max-error", arguments.maxError, 0, kMax, "fail above this largest absolute error");
    addNumberOption(*command, "--max-relmse", arguments.maxRelativeMse, 0, kMax,
                    "fail above this mean of (A - B)^2 / (B^2 + epsilon)");
    addNumberOption(*command, "--max-mean-difference", arguments.maxMeanDifference, 0, kMax,
                    "fail when a channel's mean(A) / mean(B) is further than this from 1");
    addNumberOption(*command, "--mean-within", arguments.meanWithin, 0, kMax,
                    "fail unless the 95 % interval of every channel's mean(A) / mean(B) lies this close to 1");
    command->add_flag("--noise-alone", arguments.requireNoiseAlone,
                      "fail unless the mean squared error is what the variance channels add up to");
    command->add_flag("--agree", arguments.requireAgreement,
                      "fail unless the images agree within their noise (their variance channels), or are equal");
    command->add_flag("--json", arguments.json, "print as JSON");
    command->footer(
        "Examples:\n"
        "  parhelion compare cloud.exr oracle.exr\n"
        "  parhelion compare cloud.exr oracle.exr --agree --error difference.exr\n"
        "  parhelion compare cloud.exr oracle.exr --max-relmse 0.01 --max-mean-difference 0.002\n\n"
        "Exit codes: 0 within every limit given, 1 beyond one, 2 bad input.");
    return command;
}

}  // namespace parhelion::app
