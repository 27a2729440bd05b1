# The JSON library is parsed once for the whole folder.
if(CRESCENT_PRECOMPILED)
  target_precompile_headers(crescent_report PRIVATE <nlohmann/json.hpp>)
endif()
