# The JSON library is parsed once for the whole folder.
if(CRESCENT_PRECOMPILED)
  target_precompile_headers(crescent_verdicts PRIVATE <nlohmann/json.hpp>)
endif()
# Every verdict has a `judge` of its own.
set_target_properties(crescent_verdicts PROPERTIES UNITY_BUILD OFF)
