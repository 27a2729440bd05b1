// The parts of a small scene as text, for tests of what is read: a ball or a floor in even light, 8 x 8 pixels.
#pragma once

#include <string>

namespace crescent::test {

inline const std::string view_text =
    "[image]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nvfov_deg = 40\n";
inline const std::string ball_text =
    "[shapes.ball]\nkind = \"sphere\"\ncenter = [0, 1, 0]\nradius = 1\nrho_d = [0.5, 0.5, 0.5]\n";
inline const std::string floor_text =
    "[shapes.floor]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nrho_d = [0.5, 0.5, 0.5]\n";
inline const std::string fill_text = "[fill]\nradiance = [1, 1, 1]\n";

/// A complete scene. Its last table is an arm, so that a test can append keys to it.
inline const std::string room_text = view_text + ball_text + fill_text + "[arms.cosine]\nn = 4\n";

}  // namespace crescent::test
