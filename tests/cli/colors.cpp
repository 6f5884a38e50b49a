// What --color takes, in the program: files and refusals.
#include <filesystem>
#include <string>

#include "tests/catch.h"
#include "tests/cli/process.h"

