"""Several lobes in one sampler: selection, probabilities, and densities."""

import numpy as np
from parts import cosine, cosine_pdf, dot, ggx_f, ggx_pdf, half, lambert, reflect, sample_ggx_m

from crescent import Sampler
from crescent.field import Fault

ALPHA = 0.3
DIFFUSE = lambert(0.4)
GLOSS = ggx_f(ALPHA, 0.5)
GLOSS_PDF = ggx_pdf(ALPHA)


def f(wo, wi):
    return DIFFUSE(wo, wi) + GLOSS(wo, wi)


def gloss(wo, u):
    return reflect(wo, sample_ggx_m(u, ALPHA))


def blend(share, said_share=None, said=None):
    """Lambert with the probability share(wo), else GGX; `said_share`: the share used by pdf(w); `said`: the pdf
    returned with a draw."""
    weight = said_share or (lambda wo, wi: share(wo))

    def pdf(wo, wi):
        s = weight(wo, wi)
        return s * cosine_pdf(wi) + (1 - s) * GLOSS_PDF(wo, wi)

    def sample(wo, u):
        diffuse = u[:, 2] < share(wo)
        wi = np.where(diffuse[:, None], cosine(u)[0], gloss(wo, u))
        return wi, said(wo, wi, diffuse) if said else pdf(wo, wi)

    return Sampler(sample, pdf, f, name="blend", u=3)


def even(wo):
    return np.full(len(wo), 0.5)


def schlick(c):
    return 0.04 + 0.96 * (1 - np.clip(c, 0, 1)) ** 5


def thresholds(cumulative):
    """The GGX lobe with 0.4, Lambert with 0.6, by u[:, 2] against thresholds."""

    def pdf(wo, wi):
        return 0.6 * cosine_pdf(wi) + 0.4 * GLOSS_PDF(wo, wi)

    def sample(wo, u):
        shiny = u[:, 2] < 0.4
        wi = np.where(shiny[:, None], gloss(wo, u), cosine(u)[0])
        drawn = shiny | (u[:, 2] < (1.0 if cumulative else 0.6))
        return wi, np.where(drawn, pdf(wo, wi), 0)

    return Sampler(sample, pdf, f, name="thresholds", u=3)


def doubled(wo, wi, diffuse):
    own = np.where(diffuse, cosine_pdf(wi), GLOSS_PDF(wo, wi))
    return own + 0.5 * cosine_pdf(wi) + 0.5 * GLOSS_PDF(wo, wi)


FAULTS = [
    Fault(
        "a blend whose pdf is that of the chosen lobe alone",
        "Mitsuba 3",
        "https://github.com/mitsuba-renderer/mitsuba3/pull/1681",
        "sample() of a blend returns the density of the chosen lobe, pdf() that of the mixture: MIS weights do not "
        "sum to one.",
        ("identity",),
        blend(even, said=lambda wo, wi, d: 0.5 * np.where(d, cosine_pdf(wi), GLOSS_PDF(wo, wi))),
        blend(even),
    ),
    Fault(
        "lobe weight computed from different directions in pdf and sample",
        "three-gpu-pathtracer",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/847",
        "The Fresnel share is computed at n when a lobe is chosen and at the half vector when the density is "
        "evaluated.",
        ("normalised", "density"),
        blend(lambda wo: 1 - schlick(wo[:, 2]), said_share=lambda wo, wi: 1 - schlick(dot(wo, half(wo, wi)))),
        blend(lambda wo: 1 - schlick(wo[:, 2])),
    ),
    Fault(
        "lobes chosen by thresholds that are not cumulative",
        "Unity SS Path Tracing",
        "https://github.com/jiaozi158/UnitySSPathTracingURP/pull/8",
        "The probability of each lobe is compared with the same random number without adding the previous ones: 0.4 "
        "of the paths end.",
        ("normalised", "density"),
        thresholds(False),
        thresholds(True),
    ),
    Fault(
        "the mixture's pdf added to that of the chosen lobe",
        "Exposure Render",
        "https://github.com/ThomasKroes/exposure-render/issues/19",
        "The sampled lobe has already written its pdf; the densities of both lobes are added to it.",
        ("identity",),
        blend(even, said=doubled),
        blend(even),
    ),
]
