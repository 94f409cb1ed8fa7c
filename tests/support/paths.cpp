#include "support/paths.h"

// The build's own paths reach this file alone, so that others compile the same wherever the checkout lies.
namespace parhelion::test {

const std::string& projectFolder() {
    static const std::string folder = PARHELION_ROOT;
    return folder;
}

const std::string& programFile() {
    static const std::string file = PARHELION_PROGRAM;
    return file;
}

}  // namespace parhelion::test
