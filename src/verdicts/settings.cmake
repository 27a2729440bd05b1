# Every verdict has a `judge` of its own.
set_target_properties(crescent_verdicts PROPERTIES UNITY_BUILD OFF)
