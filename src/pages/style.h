// The style sheet of the report: one column of about seventy characters, tables and figures a little wider, light and
// dark, and paper.
#pragma once

namespace crescent::inline pages {

/// Holds no '<' and no '&', so that it may stand in XHTML as it is.
extern const char* const style_sheet;

}  // namespace crescent::inline pages
