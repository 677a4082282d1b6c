// Catch2 2.13, as Debian 12 has it; precompiled once for all tests.
#pragma once

#include <catch2/catch.hpp>
