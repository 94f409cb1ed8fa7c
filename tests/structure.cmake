# What design asks of the sources themselves, checked by scripts; label unit.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function(structure_test property)
    add_test(NAME Structure.${property} COMMAND ${ARGN})
    set_tests_properties(Structure.${property} PROPERTIES LABELS unit TIMEOUT 120 SKIP_RETURN_CODE 77)
endfunction()

set(tools ${CMAKE_SOURCE_DIR}/tools)
structure_test(FoldersIncludeOnlyFloorsBelow ${Python3_EXECUTABLE} ${tools}/check_floors.py)
structure_test(EveryShaderHasItsTwin ${Python3_EXECUTABLE} ${tools}/check_mirror.py)
structure_test(EveryMirroredFunctionHasAParityRecord ${Python3_EXECUTABLE} ${tools}/check_parity_coverage.py)
structure_test(EveryHardCaseIsExplainedAndItsTestsExist ${Python3_EXECUTABLE} ${tools}/check_hard_cases.py)
structure_test(FilesAndFunctionsStaySmall ${Python3_EXECUTABLE} ${tools}/check_sizes.py)
structure_test(CodeIsFormatted bash ${tools}/check_style.sh)
structure_test(ChecksFindSeededViolations ${Python3_EXECUTABLE} ${tools}/checks_test.py)
structure_test(ToolsAnswerMistakesWithoutATraceback ${Python3_EXECUTABLE} ${tools}/tools_test.py)

# tools/validate itself, on its cheapest cases.
add_test(NAME Validation.PassesWhatIsRightAndFailsWhatIsWrong
         COMMAND ${Python3_EXECUTABLE} ${tools}/validation/validation_test.py $<TARGET_FILE_DIR:parhelion>)
set_tests_properties(Validation.PassesWhatIsRightAndFailsWhatIsWrong PROPERTIES LABELS render TIMEOUT 300)
