// Each equation is one expression of the header's pieces; terms used by several, such as f_r, L_i and n.omega, are
// functions of their own.
#include "report/mathml.h"

#include <fmt/format.h>

namespace crescent::mathml {
namespace {

M n_dot_omega(std::string_view index = "") { return paren({mi("n"), mo("⋅"), omega(index)}); }
M plus_s() { return row({mi("s"), mo("+"), mn("1")}); }
M Y(const M& low) { return sub(mi("Y"), low); }
M f_r(std::string_view index) { return row({sub(mi("f"), mi("r")), paren({omega(index), mo(","), omega("o")})}); }
M L_i(std::string_view index) { return row({sub(mi("L"), mi("i")), paren({omega(index)})}); }
M hemisphere() { return sup(upright("Ω"), mo("+")); }
M index_from_one() { return row({mi("k"), mo("="), mn("1")}); }

}  // namespace

M in_line(const M& inside) { return "<math>" + inside + "</math>"; }

M in_cell(const M& inside) { return "<math displaystyle=\"true\">" + inside + "</math>"; }

M display(const M& inside, std::string_view alt) {
    return fmt::format(
        "<div class=\"equation\"><math display=\"block\" alttext=\"{}\">{}</math></div>\n", alt, row({inside}));
}

M omega(std::string_view index) { return index.empty() ? mi("ω") : sub(mi("ω"), mi(index)); }

M rmse(std::string_view region) {
    const M name = "<mi mathvariant=\"normal\">RMSE</mi>";
    return region.empty() ? name : sub(name, mi(region));
}

M integral() {
    return row({sub(mi("L"), mi("o")), paren({omega("o")}), mo("="), sub(mo("∫"), hemisphere()), f_r(""), space(),
        L_i(""), space(), n_dot_omega(), space(), upright("d"), omega()});
}

M estimator() {
    return row({sub(hat(mi("L")), mi("o")), mo("="), frac(mn("1"), mi("N")), under(mo("∑"), index_from_one(), mi("N")),
        frac(row({f_r("k"), space(), L_i("k"), space(), n_dot_omega("k")}), row({mi("p"), paren({omega("k")})}))});
}

M mirror() {
    return row(
        {mi("R"), mo("="), mn("2"), paren({mi("n"), mo("⋅"), omega("o")}), space(), mi("n"), mo("−"), omega("o")});
}

M rmse_region() {
    const M square = sup(paren({Y(mi("N")), paren({mi("x")}), mo("−"), Y(upright("ref")), paren({mi("x")})}), mn("2"));
    return row({rmse("A"), mo("="),
        root(row({frac(mn("1"), abs({mi("A")})), "<munder>" + mo("∑") + row({mi("x"), mo("∈"), mi("A")}) + "</munder>",
            square}))});
}

M variance() {
    return row({upright("var"), paren({mi("x")}), mo("="),
        frac(mn("1"), row({mi("N"), paren({mi("N"), mo("−"), mn("1")})})), under(mo("∑"), index_from_one(), mi("N")),
        sup(paren({sub(mi("X"), mi("k")), mo("−"), bar(mi("X"))}), mn("2"))});
}

M firefly() {
    return row({abs({Y(mi("N")), mo("−"), Y(upright("ref"))}), mo(">"), mi("k"), space(), Y(upright("ref"))});
}

M pareto_index() { return row({mi("k"), mo("="), frac(row({mi("s"), mo("−"), mn("1")}), plus_s())}); }

M lost_share() { return frac(row({mn("1"), mo("−"), mi("cos"), sub(mi("θ"), mi("R"))}), mn("2")); }

M capped_mean() {
    return row({sub(mi("ρ"), mi("s")), mo("+"), sub(mi("ρ"), mi("d")),
        paren({mn("1"), mo("−"), sup(mn("2"), row({mo("−"), mi("b"), paren({mn("1"), mo("−"), mi("k")})}))})});
}

M power_law() { return row({rmse(), mo("∝"), sup(mi("N"), mi("m"))}); }

}  // namespace crescent::mathml
