-- A package for xmake and the sources that it lies in:
--     includes("LIGHTBIN/packaging/xmake")
--     add_requires("lightbin")
--     target("yours") set_languages("c++20") add_packages("lightbin")
package("lightbin")
    set_kind("library", {headeronly = true})
    set_description("Bins thousands of lights into screen tiles or clusters, for any renderer")
    set_license("MIT")
    set_sourcedir(path.join(os.scriptdir(), "..", ".."))

    on_install(function (package)
        os.cp("include", package:installdir())
        os.cp("LICENSE", package:installdir())
    end)

    on_test(function (package)
        assert(package:check_cxxsnippets({test = "lightbin::Binner<> binner;"},
            {configs = {languages = "c++20"}, includes = "lightbin/lightbin.hpp"}))
    end)
package_end()
