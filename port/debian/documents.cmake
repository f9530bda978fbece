# Copyright and changelog, which Debian's policy requires of every package. Run where the component debian is installed: by CPack.
# goe_maintainer, goe_version, goe_license (a file), goe_documents (a folder to work in) are set by cpack.cmake.
if(NOT goe_maintainer)
    message(FATAL_ERROR "who answers for the Debian package? -DGOE_DEBIAN_MAINTAINER=\"Name <address>\"")
endif()

file(READ ${goe_license} license)
string(STRIP "${license}" license)
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(REGEX REPLACE "\n" "\n " license "${license}")
file(WRITE ${goe_documents}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\n"
    "Copyright: 2026 the goe authors\nLicense: MIT\n ${license}\n")

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, if it is set
file(WRITE ${goe_documents}/changelog "goe (${goe_version}-1) unstable; urgency=medium\n\n  * Version ${goe_version}.\n\n"
    " -- ${goe_maintainer}  ${now}\n")
execute_process(COMMAND gzip -9 -n -c ${goe_documents}/changelog OUTPUT_FILE ${goe_documents}/changelog.Debian.gz
    RESULT_VARIABLE status)
if(status)
    message(FATAL_ERROR "gzip of the changelog: ${status}")
endif()
file(INSTALL ${goe_documents}/copyright ${goe_documents}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_PREFIX}/share/doc/libgoe-dev)
