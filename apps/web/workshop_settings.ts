// How the page checks a user's sampler.

/** Evaluations at each w_o: a tenth of the program's. */
export const evaluations = 150_000;
/** Where it is checked, theta and azimuth in degrees. */
export const four: readonly [number, number][] = [[0, 0], [30, 0], [60, 250], [85, 75]];
