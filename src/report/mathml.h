// Presentation MathML (MathML Core) in small pieces, which browsers render without a library. Letters as in Walter et
// al. and the usual rendering texts: omega for directions, n for the normal, R for the mirror direction of omega_o.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace crescent::mathml {

using M = std::string;

/// Returns <tag>inside</tag>.
inline M wrap(std::string_view tag, const M& inside) {
    M out;
    for (const std::string_view part : {std::string_view("<"), tag, std::string_view(">"), std::string_view(inside),
             std::string_view("</"), tag, std::string_view(">")})
        out += part;
    return out;
}
/// A letter, an operator, a number, a word, a space.
inline M mi(std::string_view letter) { return wrap("mi", M(letter)); }
inline M upright(std::string_view word) { return "<mi mathvariant=\"normal\">" + M(word) + "</mi>"; }
inline M mn(std::string_view digits) { return wrap("mn", M(digits)); }
inline M mo(std::string_view sign) { return wrap("mo", M(sign)); }
inline M space() { return "<mspace width=\"0.17em\" />"; }
inline M row(std::initializer_list<M> parts) {
    M all;
    for (const M& part : parts) all += part;
    return wrap("mrow", all);
}
/// Indices, powers, fractions, roots.
inline M sub(const M& base, const M& low) { return wrap("msub", base + low); }
inline M sup(const M& base, const M& high) { return wrap("msup", base + high); }
inline M subsup(const M& base, const M& low, const M& high) { return wrap("msubsup", base + low + high); }
inline M under(const M& base, const M& low, const M& high) { return wrap("munderover", base + low + high); }
inline M frac(const M& top, const M& bottom) { return wrap("mfrac", top + bottom); }
inline M root(const M& inside) { return wrap("msqrt", inside); }
inline M hat(const M& base) { return "<mover accent=\"true\">" + base + mo("^") + "</mover>"; }
inline M bar(const M& base) { return "<mover accent=\"true\">" + base + mo("¯") + "</mover>"; }
inline M abs(std::initializer_list<M> parts) {
    return row({"<mo form=\"prefix\" stretchy=\"false\">|</mo>", row(parts),
        "<mo form=\"postfix\" stretchy=\"false\">|</mo>"});
}
/// Brackets that grow with their content.
inline M paren(std::initializer_list<M> parts) { return row({mo("("), row(parts), mo(")")}); }

/// In a line of text, and on a line of its own (with words for screen readers).
M in_line(const M& inside);
M in_cell(const M& inside);  // in a table: fractions at full size
M display(const M& inside, std::string_view alt);

// The equations of the report.
M omega(std::string_view index = "");
M rmse(std::string_view region = "");
M integral();      // L_o, over the upper hemisphere
M estimator();     // its estimate from N samples
M mirror();        // R
M rmse_region();   // root mean square over a region
M variance();      // of the mean of N samples
M firefly();       // |Y - Y_ref| > k Y_ref
M pareto_index();  // k = (s-1)/(s+1)
M lost_share();    // (1 - cos theta_R)/2
M capped_mean();   // rho_s + rho_d (1 - 2^(-b(1-k)))
M power_law();     // RMSE ~ N^slope

}  // namespace crescent::mathml
