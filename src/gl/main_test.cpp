// Runs the tests of this folder if a GL context is available; else reports it and returns 77, which ctest counts as
// skipped.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/gl_test_scene.h"

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    try {
        const crescent::gl::Context& context = crescent::gl::test::context();
        std::cout << "on " << context.renderer() << ", GL " << context.version() << std::endl;
    } catch (const crescent::OutputError& e) {
        std::cout << "skipped: " << e.what() << std::endl;
        return 77;
    }
    return RUN_ALL_TESTS();
}
