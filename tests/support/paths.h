#pragma once

#include <string>

namespace parhelion::test {

/// The folder of this checkout.
const std::string& projectFolder();

/// The program under test.
const std::string& programFile();

}  // namespace parhelion::test
