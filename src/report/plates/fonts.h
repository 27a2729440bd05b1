// The fonts beside the program: a package that brings Inter with it needs none of the machine's.
#pragma once

namespace crescent::plates {

/// Makes ../share/crescent/fonts/fonts.conf, seen from the program's folder, Fontconfig's configuration, where that
/// file exists and FONTCONFIG_FILE is not set. Before Fontconfig is first used.
void use_fonts_beside_program();

}  // namespace crescent::plates
