"""Names and units of the metrics in figures and tables, and those of which the smallest is the best."""

RADIANCE = "W sr$^{-1}$ m$^{-2}$"
UNITS = {
    **dict.fromkeys(("y_mean", "rmse", "rmse_frame", "largest"), RADIANCE),
    **dict.fromkeys(("var", "bias_sq", "mse"), f"({RADIANCE})$^2$"),
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
}
RANKED = frozenset({"rmse", "rmse_frame", "var", "mse", "rel_mse", "smape", "flip", "fireflies"})
