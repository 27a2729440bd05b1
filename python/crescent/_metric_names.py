"""Names and units of the metrics in figures and tables, and those of which the smallest is the best."""

RADIANCE = "W sr$^{-1}$ m$^{-2}$"
UNITS = {
    **dict.fromkeys(("y_mean", "rmse", "rmse_frame", "largest"), RADIANCE),
    **dict.fromkeys(("var", "bias_sq", "mse"), f"({RADIANCE})$^2$"),
    "efficiency_n": f"({RADIANCE})$^{{-2}}$",
    "efficiency_time": f"({RADIANCE})$^{{-2}}$ s$^{{-1}}$",
}
NAMES = {
    "rmse": "RMSE",
    "rmse_frame": "RMSE of the frame",
    "var": "variance",
    "y_mean": "mean Y",
    "tail_k": "k-hat",
    "rel_mse": "relMSE",
    "smape": "SMAPE",
    "bias_sq": "squared bias",
    "flip": "FLIP",
    "horizon_frac": "horizon share",
    "efficiency_n": "efficiency at equal N",
    "efficiency_time": "efficiency at equal time",
}
RANKED = frozenset({"rmse", "rmse_frame", "var", "mse", "rel_mse", "smape", "flip", "fireflies"})

#: Names of `crescent.compare` for metrics of a run that have another name there.
ALIASES = {"relmse": "rel_mse", "bias2": "bias_sq"}

#: Efficiencies, 1 / (variance of N samples times N) and 1 / (variance times seconds): the largest is the best.
LARGEST_IS_BEST = frozenset({"efficiency_n", "efficiency_time"})
