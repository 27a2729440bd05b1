// Whether text is well-formed XML, as far as the outputs of this folder use it: one root, tags balanced, attributes
// quoted and not repeated, only the five named references and numeric ones, no bare '<' or '&'.
#pragma once

#include <cctype>
#include <set>
#include <string>
#include <vector>

namespace crescent::testing {

class XmlCheck {
public:
    explicit XmlCheck(const std::string& text) : text_(text) {}

    /// "" where the text is well-formed, else what is wrong and where.
    std::string complaint() {
        while (at_ < text_.size() && say_.empty()) text_[at_] == '<' ? markup() : character();
        if (say_.empty() && !open_.empty()) fail("not closed: " + open_.back());
        if (say_.empty() && roots_ != 1) fail("not one root");
        return say_;
    }

private:
    void fail(const std::string& what) {
        if (say_.empty()) say_ = what + " at byte " + std::to_string(at_) + ": " + text_.substr(at_ < 60 ? 0 : at_ - 60, 120);
    }

    void character() {
        if (text_[at_] == '&') return reference();
        if (open_.empty() && !std::isspace(static_cast<unsigned char>(text_[at_]))) fail("text outside the root");
        ++at_;
    }

    void reference() {
        const auto end = text_.find(';', at_);
        const std::string name = end == std::string::npos ? "" : text_.substr(at_ + 1, end - at_ - 1);
        static const std::set<std::string> known{"amp", "lt", "gt", "quot", "apos"};
        if (!known.count(name) && (name.empty() || name[0] != '#')) return fail("unknown reference");
        at_ = end + 1;
    }

    void markup() {
        if (text_.compare(at_, 2, "<?") == 0 || text_.compare(at_, 2, "<!") == 0) {
            at_ = text_.find('>', at_) + 1;
        } else if (text_.compare(at_, 2, "</") == 0) {
            const auto end = text_.find('>', at_);
            const std::string name = text_.substr(at_ + 2, end - at_ - 2);
            if (open_.empty() || open_.back() != name) return fail("closes " + name);
            open_.pop_back();
            at_ = end + 1;
        } else {
            tag();
        }
    }

    std::string word() {
        std::string out;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-'))
            out += text_[at_++];
        return out;
    }

    void tag() {
        ++at_;
        const std::string name = word();
        if (name.empty()) return fail("bare <");
        std::set<std::string> seen;
        while (say_.empty() && at_ < text_.size()) {
            while (std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
            const bool empty = text_.compare(at_, 2, "/>") == 0;
            if (empty || text_[at_] == '>') {
                if (open_.empty()) ++roots_;
                if (!empty) open_.push_back(name);
                at_ += empty ? 2 : 1;
                return;
            }
            attribute(seen);
        }
    }

    void attribute(std::set<std::string>& seen) {
        const std::string name = word();
        if (name.empty() || !seen.insert(name).second) return fail("attribute " + name);
        if (text_.compare(at_, 2, "=\"") != 0) return fail("attribute not quoted");
        at_ += 2;
        while (at_ < text_.size() && text_[at_] != '"' && say_.empty()) {
            if (text_[at_] == '<') return fail("< in an attribute");
            if (text_[at_] == '&')
                reference();
            else
                ++at_;
        }
        ++at_;
    }

    const std::string& text_;
    std::size_t at_ = 0;
    std::vector<std::string> open_;
    int roots_ = 0;
    std::string say_;
};

inline std::string xml_complaint(const std::string& text) { return XmlCheck(text).complaint(); }

}  // namespace crescent::testing
