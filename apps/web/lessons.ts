// Lessons: the question, the measurement that answers it, and the values that may be changed. No number is hard-coded:
// the core measures and names the result, which selects a sentence of `says`. Formulas are between dollar signs.

/** An arm over a region at one N on several seeds; `as`: its name if that is not the arm's. */
export interface Measured { arm: string; n: number; region: "H" | "S"; seeds: number; set?: readonly string[]; as?: string }

export type Ask =
  | { kind: "choice"; options: readonly { value: string; words: string }[] }
  | { kind: "region" } // a box, drawn or entered
  | { kind: "slider"; low: number; high: number; step: number; unit: string };

/** How the core answers: from measurements, from one sample, from a furnace, or from the verdicts of samplers. */
export type Answer =
  | { by: "largest" | "smallest" | "factor" | "spread"; of: readonly Measured[]; beside?: readonly Measured[] } // `beside`: reported only
  | { by: "firefly"; arm: string; n: number; region: "H" | "S" }
  | { by: "furnace"; name: string; n: number }
  | { by: "support" | "chi-square" | "t-test" | "which"; samplers: readonly string[]; theta: number; surface?: string };

export interface Lesson {
  id: string; title: string; minutes: number; aim: string; question: string; ask: Ask; answer: Answer;
  says: Readonly<Record<string, string>>; // by the name of the result
  arms: readonly string[]; n: number; view?: "heat"; play: readonly string[]; // paths of settings, or "n"
  check?: { samplers: readonly { value: string; words: string }[]; theta: readonly number[] }; // uses these instead
  furnace?: { s: readonly number[]; n: readonly number[]; own: number }; // or these; own: the experiment's s
}

/** Whether it uses the bench below it. */
export const onBench = (lesson: Lesson): boolean => !lesson.check && !lesson.furnace;

const names = (words: readonly string[]): readonly { value: string; words: string }[] =>
  words.map((word) => ({ value: word, words: word }));
const ranked = (words: readonly string[]): readonly { value: string; words: string }[] =>
  [...names(words), { value: "overlap", words: "none: the intervals of the seeds overlap" }];
const three = ["uniform", "cosine", "phong"] as const;
const at = (arm: string, region: "H" | "S", n = 64, more: Partial<Measured> = {}): Measured => ({ arm, n, region, seeds: 8, ...more });
const overlap = "The first and the next overlap on these seeds: more seeds may rank them, one seed cannot.";
const six = ["sqrt forgotten", "pdf off by 1 %", "phi over half a turn", "cosine", "cosine folded in twice", "s+2 for s+1 in the pdf"] as const;

export const lessons: readonly Lesson[] = [
  {
    id: "sparkle", title: "Which column sparkles where?", minutes: 5, arms: three, n: 64, play: ["sphere.s", "seed"],
    aim: "Same image, same number of samples, same random numbers: only the aim differs, and with it the place of the noise.",
    question: "Three arms draw 64 samples a pixel: uniform, cosine and phong. Draw a box in which phong will be the noisiest of the three.",
    ask: { kind: "region" }, answer: { by: "largest", of: three.map((arm) => at(arm, "S")) },
    says: {
      uniform: "In this box the widest aim is the noisiest. The lines above say how few of its directions met the light: the fewer, the more each weighs. Look for a box in which phong is noisier.",
      cosine: "In this box the arm that follows the cosine is the noisiest. The lines above say how few of its directions met the light: the fewer, the more each weighs. Look for a box in which phong is noisier.",
      phong: "In this box phong is the noisiest. Away from its mirror direction its density nearly vanishes, and $\\frac{1}{p}$ is large: click a speck below, and its largest sample is taken apart. Then draw a box over the highlight H, and compare.", overlap,
    },
  },
  {
    id: "four-times", title: "Four times the samples", minutes: 5, arms: ["cosine"], n: 64, play: ["n", "seed"],
    aim: "Where the variance is finite, the error of a mean falls as $\\frac{1}{\\sqrt{N}}$.",
    question: "Cosine draws 16 samples a pixel, then 64. By what factor does the RMSE of H fall?",
    ask: { kind: "slider", low: 1, high: 8, step: 0.1, unit: "times" },
    answer: { by: "factor", of: [at("cosine", "H", 16), at("cosine", "H", 64)] },
    says: {
      falls: "The error fell on every seed. Hold the factor beside the one that a finite variance gives: the region has few pixels, and each seed its own luck.",
      rises: "On some seeds the error rose. The law is one of the mean over many seeds: the lines above say how few directions met the light, and so how much is left to luck.",
    },
  },
  {
    id: "four-times-phong", title: "The same, for Phong in the surround", minutes: 5, arms: ["phong"], n: 256, play: ["n", "seed", "sphere.s"],
    aim: "Where the tail is heavy, more samples need not mean a smaller error.",
    question: "Phong draws 64 samples a pixel, then 256. By what factor does the RMSE of the surround S fall? A number below 1 says that it rises.",
    ask: { kind: "slider", low: 0.1, high: 4, step: 0.1, unit: "times" },
    answer: { by: "factor", of: [at("phong", "S", 64), at("phong", "S", 256)] },
    says: {
      rises: "On some seeds more samples gave a larger error: one sample with a huge $\\frac{1}{p}$ is enough. The tail's $k$ stands under the picture: from $\\frac{1}{2}$ on the variance is infinite, and the law of the square root has no hold.",
      falls: "On these seeds the error fell each time. The tail's $k$ under the picture says how far to trust that: from $\\frac{1}{2}$ on the variance is infinite.",
    },
  },
  {
    id: "firefly", title: "Who made this firefly?", minutes: 5, arms: ["phong"], n: 64, view: "heat", play: ["sphere.s", "firefly_k"],
    aim: "A sample is a quotient, $X=\\frac{f\\,L\\,\\cos\\theta}{p}$. A small divisor makes a large sample.",
    question: "In S, phong's brightest pixel was made by one sample. Which factor of f, L, cos and 1/p is the largest?",
    ask: { kind: "choice", options: names(["f", "L", "cos", "1/p"]) }, answer: { by: "firefly", arm: "phong", n: 64, region: "S" },
    says: {
      "1/p": "The divisor made it: the arm drew a direction that it hardly ever draws. Its hemisphere is open below, with the sample taken apart; click any other speck.",
      "L": "The light made it: a sample met the key. Its hemisphere is open below, with the sample taken apart; click any other speck.",
      cos: "The cosine is the largest factor, and it is at most 1: this sample is small in every other way. Its hemisphere is open below; click any other speck.",
      none: "No sample of this region met any light: there is no firefly to take apart.",
      "f": "The lobe made it. Its hemisphere is open below, with the sample taken apart; click any other speck.",
    },
  },
  {
    id: "sharper", title: "Sharper and sharper", minutes: 5, arms: ["phong"], n: 64, play: ["sphere.s"],
    aim: "An exponent changes the lobe, the density and the truth together: a sharper aim is not a better one everywhere.",
    question: "The sphere's exponent s is 8, 32 or 128. At which one is phong's RMSE of the highlight H the largest?",
    ask: { kind: "choice", options: ranked(["8", "32", "128"]) },
    answer: { by: "largest", of: ["8", "32", "128"].map((s) => at("phong", "H", 64, { set: [`sphere.s=${s}`], as: `phong, s = ${s}` })) },
    says: {
      "8": "The widest lobe is the noisiest here. Compare the shares of directions that met the light, and the means: with s the picture itself changes, so hold each RMSE against its own mean.",
      "32": "Neither the widest nor the sharpest lobe, the one between is the noisiest here. With s the picture itself changes: hold each RMSE against its own mean.",
      "128": "The sharpest aim is the noisiest here. Compare the shares of directions that met the light, and the means: with s the picture itself changes, so hold each RMSE against its own mean.",
      overlap: "The first and the next overlap on these seeds. Compare the shares of directions that met the light, and the means: with s the picture itself changes, so hold each RMSE against its own mean.",
    },
  },
  {
    id: "furnace", title: "A furnace that reads short", minutes: 8, arms: ["cosine", "phong"], n: 64, play: [], furnace: { s: [8, 32, 128, 512], n: [64, 1024, 16384, 65536], own: 32 },
    aim: "A sum that comes out short may lack precision, hold a bug, or wait for samples that are too rare.",
    question: "Light of 1 comes from everywhere: phong ought to read rho_d + rho_s. Where it reads less, is it precision, a bug, or the tail?",
    ask: { kind: "choice", options: [{ value: "precision", words: "precision" }, { value: "bug", words: "a bug" }, { value: "tail", words: "the tail" }] },
    answer: { by: "furnace", name: "phong_combined", n: 1024 },
    says: {
      tail: "It is farther off than sums of floats can be, and its tail looks too heavy for a variance: then the standard error beside it bounds nothing, and what is missing may sit in samples too rare to have come.",
      bug: "It is off by more than its standard error allows, and no tail excuses it.",
      precision: "It is no farther off than sums of floats may be.",
      none: "It is not off by more than four of its standard errors: here there is nothing to explain.",
    },
  },
  {
    id: "unbiased", title: "Is the Phong arm unbiased off the normal?", minutes: 8, arms: ["cosine", "phong"], n: 256, play: [],
    aim: "A density that is 0 where f is not loses that light for ever, however many samples there are.",
    question: "Phong aims about the mirror direction R. With R 60 degrees off the normal, does its mean come out right on a surface that is partly diffuse?",
    ask: { kind: "choice", options: [{ value: "right", words: "yes, it is unbiased" }, { value: "wrong", words: "no, some light is out of reach" }] },
    answer: { by: "support", samplers: ["phong"], theta: 60, surface: "Lambert + Phong" },
    check: { samplers: names(["phong", "cosine", "mixture", "blinn"]), theta: [0, 15, 30, 45, 60, 75, 85] },
    says: {
      wrong: "What lies more than 90 degrees from R is never drawn, and a diffuse surface reflects it all the same. Check it at the normal, and check the mixture, which also aims by the cosine.",
      right: "No light is out of reach at this w_o.",
      inconclusive: "It stays open at this w_o: the line above says what would settle it.",
    },
  },
  {
    id: "chi-square", title: "A chi-square test passes. Is the sampler right?", minutes: 8, arms: ["phong"], n: 64, play: [],
    aim: "A chi-square test compares draws with the density, and nothing else.",
    question: "A sampler draws what its density says, and a chi-square test passes. Can it still be wrong?",
    ask: { kind: "choice", options: [{ value: "wrong", words: "yes" }, { value: "right", words: "no" }] },
    answer: { by: "chi-square", samplers: ["cosine left out of the weight"], theta: 45 },
    check: { samplers: names(["cosine left out of the weight", "clamped weights", "BRDF scaled by 1.01", "non-reciprocal f", "phong"]), theta: [0, 45, 75] },
    says: {
      "right-wrong": "The density is the one that is drawn, and the sampler is wrong all the same: it takes a verdict that looks at f, at the weight or at the mean to see it. Check the others of the list.",
      "right-right": "Chi-square passes, and nothing else is wrong either.",
      "wrong-wrong": "Here chi-square does not even pass.", "wrong-right": "Here chi-square alone accuses it.",
    },
  },
  {
    id: "t-test", title: "A t-test rejects. Is the sampler wrong?", minutes: 8, arms: ["phong"], n: 64, play: [],
    aim: "A t-test needs a variance. Where the tail has none, its rejection says nothing.",
    question: "Phong at the normal, on a surface that is partly diffuse: its mean is compared with the integral, and a t-test rejects. Is the sampler proved wrong?",
    ask: { kind: "choice", options: [{ value: "wrong", words: "yes, rejected is rejected" }, { value: "inconclusive", words: "no, it cannot be decided that way" }, { value: "right", words: "no, it is right" }] },
    answer: { by: "t-test", samplers: ["phong"], theta: 0, surface: "Lambert + Phong" },
    check: { samplers: names(["phong", "cosine", "mixture", "uniform"]), theta: [0, 15, 30, 45, 60, 75, 85] },
    says: {
      "rejects-inconclusive": "The t-test rejects, and the bench does not follow it: its standard error comes from a tail so heavy that the samples seen do not tell how far off their mean may be.",
      "rejects-wrong": "The t-test rejects, and the tail allows it to: the sampler is wrong.",
      "passes-inconclusive": "This time the t-test does not even reject; it could not be believed either way.",
      "passes-right": "The t-test does not reject, and the tail allows the question.",
      "rejects-right": "The t-test rejects at its level, and the bench, which asks a fresh seed before it accuses, does not: a level is the share of right samplers that a test rejects.",
      "passes-wrong": "The t-test does not reject, and another test of the same mean does: the lines above say by how much.",
    },
  },
  {
    id: "mixture", title: "How much of each in a mixture?", minutes: 5, arms: ["cosine", "phong", "mixture"], n: 64, play: ["sphere.s", "sphere.rho_d", "sphere.rho_s"],
    aim: "A mixture aims by the lobe with probability $q$, else by the cosine: $p=q\\,p_{\\mathrm{phong}}+(1-q)\\,p_{\\mathrm{cosine}}$, which is small nowhere. Here $q$ is the lobe's share of the albedo.",
    question: "Cosine, phong, or the mixture of both: which one has the smallest RMSE of the surround S?",
    ask: { kind: "choice", options: ranked(["cosine", "phong", "mixture"]) },
    answer: { by: "smallest", of: ["cosine", "phong", "mixture"].map((arm) => at(arm, "S")), beside: ["cosine", "phong", "mixture"].map((arm) => at(arm, "H")) },
    says: {
      cosine: "In the surround cosine is the best of the three: a sample that the mixture spends on the lobe is one that it lacks there. The lines on the highlight H say what each choice costs or saves there. Change rho_s: it is the mixture's share.",
      mixture: "In the surround the mixture is the best of the three. Hold that against the lines on the highlight H, and change rho_s: it is the mixture's share.",
      phong: "In the surround the lobe's own aim is the best of the three here. Hold that against the lines on the highlight H, and change rho_s: it is the mixture's share.",
      overlap: "In the surround the first and the next overlap on these seeds. Hold that against the lines on the highlight H, and change rho_s: it is the mixture's share.",
    },
  },
  {
    id: "seeds", title: "One seed or sixteen?", minutes: 8, arms: ["phong"], n: 64, view: "heat", play: ["seed"],
    aim: "A number from one seed has no interval; from sixteen it has one, and it may be wide.",
    question: "Sixteen seeds of phong give sixteen RMSEs of S. How many times the 5 % quantile is the 95 % quantile?",
    ask: { kind: "slider", low: 1, high: 20, step: 0.5, unit: "times" }, answer: { by: "spread", of: [at("phong", "S", 64, { seeds: 16 })] },
    says: {
      wide: "The number of one seed alone differs by more than a factor of two between lucky and unlucky seeds. Arms whose intervals overlap are not ranked.",
      narrow: "These seeds agree within a factor of two. Arms whose intervals overlap are not ranked.",
    },
  },
  {
    id: "fault", title: "Find the fault", minutes: 10, arms: ["cosine", "phong"], n: 64, play: [],
    aim: "A sampler is checked by its draws, its density and its weight, each against the others.",
    question: "Six samplers, one of them right, five with one fault each. Which one is right? The pictures show 512 draws of each over the density that it claims.",
    ask: { kind: "choice", options: [..."abcdef"].map((letter) => ({ value: letter, words: `sampler ${letter}` })) },
    answer: { by: "which", samplers: six, theta: 45 },
    check: { samplers: [..."abcdef"].map((letter, k) => ({ value: six[k]!, words: `sampler ${letter}` })), theta: [0, 45, 75] },
    says: {
      one: "The first verdict that says wrong names what disagrees with what. A fault that no eye sees in the draws may stand in the density alone.",
      none: "It is not one of the six alone that is free of a wrong verdict: the lines above say which are.",
    },
  },
];
