# target_of_test NAME: what ninja builds for a test of ctest; nothing for a script, which may use any program. Sourced
# by ./test and tests/planted/run.sh.
target_of_test() {
    case $1 in
    unit-gl-*) echo crescent_gl_tests ;;
    unit-film) echo crescent_explainer_tests ;;
    unit-calibration) echo crescent_calibration_tests ;;
    unit-*) set -- "${1#unit-}" && echo "crescent_${1%%/*}_tests" ;;
    conformance | conformance-*) echo crescent_conformance ;;
    esac
}
