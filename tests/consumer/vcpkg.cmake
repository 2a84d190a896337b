# cmake -DWORK=FOLDER -DGENERATOR=NAME -P vcpkg.cmake: runs the port for vcpkg where there is no vcpkg. The functions
# that it calls do here what matters of them for a library of headers, and refuse what they do not know.
cmake_minimum_required(VERSION 3.19)  # string(JSON)
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
set(port_folder ${root}/packaging/vcpkg/lightbin)
set(CURRENT_PACKAGES_DIR ${WORK}/packages)
file(REMOVE_RECURSE ${WORK})

file(READ ${port_folder}/vcpkg.json manifest)
string(JSON PORT GET ${manifest} name)
string(JSON version GET ${manifest} version)

function(run)
    execute_process(COMMAND ${ARGN} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# parse(ONE_VALUE MANY_VALUES ARGUMENT...): sets arg_... in a function
macro(parse one many)
    cmake_parse_arguments(arg "" "${one}" "${many}" ${ARGN})
    if(arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "${CMAKE_CURRENT_FUNCTION} takes no ${arg_UNPARSED_ARGUMENTS}")
    endif()
endmacro()

function(vcpkg_cmake_configure)
    parse(SOURCE_PATH OPTIONS ${ARGN})
    run(${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
        -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} ${arg_OPTIONS})
endfunction()

function(vcpkg_cmake_install)
    parse("" "" ${ARGN})
    run(${CMAKE_COMMAND} --build ${WORK}/build --target install)
endfunction()

# vcpkg also corrects the way from there to the headers.
function(vcpkg_cmake_config_fixup)
    parse(CONFIG_PATH "" ${ARGN})
    file(RENAME ${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH} ${CURRENT_PACKAGES_DIR}/share/${PORT})
    get_filename_component(parent ${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH} DIRECTORY)
    file(REMOVE_RECURSE ${parent})
endfunction()

function(vcpkg_install_copyright)
    parse("" FILE_LIST ${ARGN})
    configure_file(${arg_FILE_LIST} ${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright COPYONLY)
endfunction()

include(${port_folder}/portfile.cmake)

file(GLOB_RECURSE installed RELATIVE ${CURRENT_PACKAGES_DIR} ${CURRENT_PACKAGES_DIR}/*)
file(GLOB_RECURSE wanted RELATIVE ${root} ${root}/include/*)
list(APPEND wanted share/lightbin/copyright share/lightbin/lightbinConfig.cmake
    share/lightbin/lightbinConfigVersion.cmake share/lightbin/usage share/pkgconfig/lightbin.pc)
list(SORT installed)
list(SORT wanted)
if(NOT installed STREQUAL wanted)
    message(FATAL_ERROR "installed are ${installed}; wanted are ${wanted}")
endif()

set(PACKAGE_FIND_VERSION ${version})
include(${CURRENT_PACKAGES_DIR}/share/lightbin/lightbinConfigVersion.cmake)
if(NOT PACKAGE_VERSION_EXACT)
    message(FATAL_ERROR "vcpkg.json has version ${version}, the library is ${PACKAGE_VERSION}")
endif()
