// Returns whether text is well-formed XML, using expat.
#pragma once

#include <expat.h>

#include <memory>
#include <string>

namespace crescent::testing {

/// Returns "" for well-formed text, else the error, its place, and the text there.
inline std::string xml_error(const std::string& text) {
    const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate("UTF-8"), XML_ParserFree);
    if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK) return "";
    const auto at = static_cast<std::size_t>(XML_GetCurrentByteIndex(parser.get()));
    return std::string(XML_ErrorString(XML_GetErrorCode(parser.get()))) + " at byte " + std::to_string(at) + ": " +
        text.substr(at < 60 ? 0 : at - 60, 120);
}

}  // namespace crescent::testing
