// Lessons: what is asked, what answers it, what one may play with. No number is typed in here: the core measures.

/** Which number the core is asked for; `a` over `b` where both are there. */
export interface Measured {
  arm: string; n: number; region: "H" | "S"; seeds?: number; set?: readonly string[]; of?: "rmse" | "mean" | "spread";
}

export type Ask =
  | { kind: "choice"; options: readonly { value: string; words: string }[] }
  | { kind: "slider"; low: number; high: number; step: number; unit: string };

/** How the core answers: the arm with the largest or smallest number, a ratio, or one of the special questions. */
export type Answer =
  | { by: "largest" | "smallest"; of: readonly Measured[] }
  | { by: "ratio"; of: readonly [Measured, Measured] }
  | { by: "firefly"; arm: string; n: number; region: "H" | "S" }
  | { by: "furnace"; name: string; n: number };

export interface Lesson {
  id: string; title: string; minutes: number; aim: string; question: string; ask: Ask; answer: Answer;
  reveal: string; arms: readonly string[]; n: number; view?: "heat"; play: readonly string[];
}

const names = (words: readonly string[]): readonly { value: string; words: string }[] =>
  words.map((word) => ({ value: word, words: word }));
const three = ["uniform", "cosine", "phong"] as const;
const at = (arm: string, region: "H" | "S", n = 64, more: Partial<Measured> = {}): Measured => ({ arm, n, region, ...more });

export const lessons: readonly Lesson[] = [
  {
    id: "sparkle", title: "Which column sparkles where?", minutes: 5, arms: three, n: 64, play: ["sphere.s", "seed"],
    aim: "Same image, same number of samples, same random numbers: only the aim differs, and with it the place of the noise.",
    question: "Three arms draw 64 samples a pixel. In which one will the highlight H be noisiest?",
    ask: { kind: "choice", options: names(three) }, answer: { by: "largest", of: three.map((arm) => at(arm, "H")) },
    reveal: "The wider an arm aims, the seldomer it meets the small light that makes the highlight, and the heavier each meeting weighs.",
  },
  {
    id: "four-times", title: "Four times the samples", minutes: 5, arms: ["cosine"], n: 64, play: ["seed"],
    aim: "The error of a mean falls as one over the square root of N.",
    question: "Cosine draws 16 samples a pixel, then 64. By what factor does the RMSE of H fall?",
    ask: { kind: "slider", low: 1, high: 8, step: 0.1, unit: "times" },
    answer: { by: "ratio", of: [at("cosine", "H", 16), at("cosine", "H", 64)] },
    reveal: "Four times the samples halve the error, where the variance is finite and the samples are many.",
  },
  {
    id: "four-times-phong", title: "The same, for Phong in the surround", minutes: 5, arms: ["phong"], n: 256, play: ["seed", "sphere.s"],
    aim: "Where the tail is heavy, more samples need not mean a smaller error.",
    question: "Phong draws 64 samples a pixel, then 256. By what factor does the RMSE of the surround S fall? A number below 1 says that it rises.",
    ask: { kind: "slider", low: 0.1, high: 4, step: 0.1, unit: "times" },
    answer: { by: "ratio", of: [at("phong", "S", 64), at("phong", "S", 256)] },
    reveal: "Far from the mirror direction the density nearly vanishes and 1/p is huge. Whenever such a sample comes, the error jumps: the law of the square root has no hold here.",
  },
  {
    id: "firefly", title: "Who made this firefly?", minutes: 5, arms: ["phong"], n: 64, view: "heat", play: ["sphere.s", "firefly_k"],
    aim: "A sample is a quotient: f L cos over p. A small divisor makes a large sample.",
    question: "In S, phong's brightest pixel was made by one sample. Which factor of f, L, cos and 1/p is the largest?",
    ask: { kind: "choice", options: names(["f", "L", "cos", "1/p"]) }, answer: { by: "firefly", arm: "phong", n: 64, region: "S" },
    reveal: "Open any speck in the pictures below: its largest sample is taken apart under the hemisphere.",
  },
  {
    id: "sharper", title: "Sharper and sharper", minutes: 5, arms: ["phong"], n: 64, play: ["sphere.s"],
    aim: "An exponent changes the lobe, the density and the truth together: a sharper aim is not a better one everywhere.",
    question: "s = 8, 32 and 128: at which one is phong's RMSE of the highlight H largest?",
    ask: { kind: "choice", options: names(["8", "32", "128"]) },
    answer: { by: "largest", of: ["8", "32", "128"].map((s) => at("phong", "H", 64, { set: [`sphere.s=${s}`] })) },
    reveal: "A sharp lobe leaves most of the region H without samples, while the light still stands there.",
  },
  {
    id: "furnace", title: "A furnace that reads short", minutes: 8, arms: ["cosine", "phong"], n: 64, play: ["sphere.s", "sphere.rho_d"],
    aim: "A sum that comes out short may lack precision, hold a bug, or wait for samples that are too rare.",
    question: "Light of 1 from everywhere: phong must read rho_d + rho_s and reads less. Is it precision, a bug, or the tail?",
    ask: { kind: "choice", options: [{ value: "precision", words: "precision" }, { value: "bug", words: "a bug" }, { value: "tail", words: "the tail" }] },
    answer: { by: "furnace", name: "phong_combined", n: 1024 },
    reveal: "The weights of the diffuse part have so heavy a tail that the sample mean lies below the true one nearly always.",
  },
  {
    id: "mixture", title: "How much of each in a mixture?", minutes: 5, arms: ["cosine", "phong", "mixture"], n: 64, play: ["sphere.s", "sphere.rho_s"],
    aim: "One arm for the lobe, one for the rest, chosen at random: a density that is small nowhere.",
    question: "Cosine, phong, or a mixture of both by their albedos: which one has the smallest RMSE of the surround S?",
    ask: { kind: "choice", options: names(["cosine", "phong", "mixture"]) },
    answer: { by: "smallest", of: ["cosine", "phong", "mixture"].map((arm) => at(arm, "S")) },
    reveal: "The mixture keeps the cosine's reach, and pays for the highlight with samples taken from the surround.",
  },
  {
    id: "seeds", title: "One seed or sixteen?", minutes: 8, arms: ["phong"], n: 64, view: "heat", play: ["seed"],
    aim: "A number from one seed has no interval; from sixteen it has one, and it may be wide.",
    question: "Sixteen seeds of phong give sixteen RMSEs of S. How many times the 5 % quantile is the 95 % quantile?",
    ask: { kind: "slider", low: 1, high: 20, step: 0.5, unit: "times" },
    answer: { by: "ratio", of: [at("phong", "S", 64, { seeds: 16, of: "spread" }), at("phong", "S", 64, { seeds: 16, of: "spread" })] },
    reveal: "Another seed is another firefly. Arms whose intervals overlap are not ranked.",
  },
];
