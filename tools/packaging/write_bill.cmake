# SPDX-License-Identifier: Apache-2.0
# One bill of materials: cmake -DOUTPUT=x.spdx.json -DPACKAGE= -DCOMPONENT= -DVERSION= -DFILES= -DHEADS= -DNEEDS= -DKNOWN=
# -DREADELF= -P write_bill.cmake. The same input gives the same bytes: its date is SOURCE_DATE_EPOCH, else that of 0.
cmake_minimum_required(VERSION 3.25)
set(created 1970-01-01T00:00:00Z)
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC)
endif()

# t3r_package(ID NAME VERSION FIELDS...): a package; FIELDS are lines of JSON.
set(packages)
function(t3r_package id name version)
  set(fields "\"SPDXID\": \"SPDXRef-${id}\"" "\"name\": \"${name}\"" "\"downloadLocation\": \"NOASSERTION\""
    "\"filesAnalyzed\": false" ${ARGN})
  if(version)
    list(INSERT fields 2 "\"versionInfo\": \"${version}\"")
  endif()
  list(JOIN fields ",\n      " text)
  set(packages ${packages} "    {\n      ${text}\n    }" PARENT_SCOPE)
endfunction()

set(relations)
function(t3r_relation from kind to)
  set(relations ${relations} "    {\"spdxElementId\": \"SPDXRef-${from}\", \"relationshipType\": \"${kind}\",\
 \"relatedSpdxElement\": \"${to}\"}" PARENT_SCOPE)
endfunction()

set(licence "\"licenseConcluded\": \"Apache-2.0\"" "\"licenseDeclared\": \"Apache-2.0\"" "\"copyrightText\": \"NOASSERTION\"")
set(others "\"licenseConcluded\": \"NOASSERTION\"" "\"licenseDeclared\": \"NOASSERTION\""
  "\"copyrightText\": \"NOASSERTION\"")
t3r_package(Package ${PACKAGE} ${VERSION} ${licence})
t3r_relation(DOCUMENT DESCRIBES SPDXRef-Package)
if(NOT COMPONENT MATCHES "^(cameras|poses|host|host_dev)$")
  t3r_package(runtime trim3r-runtime ${VERSION} ${licence})
  t3r_relation(Package CONTAINS SPDXRef-runtime)
  t3r_relation(runtime DEPENDS_ON NONE)
endif()

# Heads: the version is the CRC-32 of the weights, as t3r_head_crc() returns it; it is at byte 12.
foreach(head ${HEADS})
  get_filename_component(name ${head} NAME_WE)
  file(SHA256 ${head} digest)
  file(STRINGS ${head} first REGEX "^[0-9]+," LIMIT_COUNT 1)
  string(REGEX MATCHALL "[0-9]+" bytes "${first}")
  list(SUBLIST bytes 12 4 bytes)
  list(REVERSE bytes)
  set(crc 1) # so that zeros in front stay
  foreach(byte ${bytes})
    math(EXPR crc "${crc} << 8 | ${byte}" OUTPUT_FORMAT HEXADECIMAL)
  endforeach()
  string(SUBSTRING ${crc} 3 8 crc)
  t3r_package(head-${name} trim3r-head-${name} ${crc} "\"packageFileName\": \"quant/heads/${name}.c\""
    "\"checksums\": [{\"algorithm\": \"SHA256\", \"checksumValue\": \"${digest}\"}]" ${licence})
  t3r_relation(Package CONTAINS SPDXRef-head-${name})
endforeach()

# What the page of `trim3r view` holds
if(COMPONENT STREQUAL "program")
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/../viewer/page/fzstd/fzstd.js first REGEX "fzstd [0-9]" LIMIT_COUNT 1)
  string(REGEX MATCH "[0-9]+[.][0-9]+[.][0-9]+" version "${first}")
  t3r_package(fzstd fzstd ${version} "\"licenseConcluded\": \"MIT\"" "\"licenseDeclared\": \"MIT\""
    "\"copyrightText\": \"Copyright (c) 2020 Arjun Barrett\""
    "\"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\",\
 \"referenceLocator\": \"pkg:npm/fzstd@${version}\"}]")
  t3r_relation(Package CONTAINS SPDXRef-fzstd)
endif()

# Libraries that the files load
set(loaded)
foreach(file ${FILES})
  if(NOT file MATCHES "\\.a$")
    execute_process(COMMAND ${READELF} --dynamic --wide ${file} OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[][]" "|" said "${said}") # brackets would hold a list of CMake's together
    string(REGEX MATCHALL "\\(NEEDED\\)[^|\n]*[|][^|\n]+" lines "${said}")
    list(TRANSFORM lines REPLACE "^.*[|]" "")
    list(APPEND loaded ${lines})
  endif()
endforeach()
list(REMOVE_DUPLICATES loaded)
list(SORT loaded)
foreach(library ${loaded})
  string(REGEX REPLACE "\\.so.*" "" file ${library})
  set(name ${file})
  set(version)
  foreach(row ${KNOWN})
    string(REPLACE "|" ";" row "${row}")
    list(GET row 0 of)
    if(of STREQUAL file)
      list(GET row 1 name)
      list(GET row 2 version)
    endif()
  endforeach()
  string(REGEX REPLACE "[^A-Za-z0-9.-]" "-" id ${library})
  set(locator pkg:generic/${name})
  if(version)
    string(APPEND locator @${version})
  endif()
  t3r_package(${id} ${name} "${version}" "\"packageFileName\": \"${library}\"" ${others}
    "\"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\",\
 \"referenceLocator\": \"${locator}\"}]")
  t3r_relation(Package DEPENDS_ON SPDXRef-${id})
endforeach()
foreach(name ${NEEDS})
  t3r_package(${name} ${name} "" ${others})
  t3r_relation(Package DEPENDS_ON SPDXRef-${name})
endforeach()
if(NOT loaded AND NOT NEEDS)
  t3r_relation(Package DEPENDS_ON NONE)
endif()

list(JOIN packages ",\n" packages)
list(JOIN relations ",\n" relations)
string(SHA256 digest "${created}${packages}${relations}")
file(WRITE ${OUTPUT} "{
  \"spdxVersion\": \"SPDX-2.3\",
  \"dataLicense\": \"CC0-1.0\",
  \"SPDXID\": \"SPDXRef-DOCUMENT\",
  \"name\": \"${PACKAGE}-${VERSION}\",
  \"documentNamespace\": \"https://spdx.org/spdxdocs/${PACKAGE}-${VERSION}-${digest}\",
  \"creationInfo\": {\"created\": \"${created}\", \"creators\": [\"Tool: trim3r-${VERSION}\"]},
  \"packages\": [
${packages}
  ],
  \"relationships\": [
${relations}
  ]
}
")
