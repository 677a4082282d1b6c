# Writes OUTPUT, a C++ file that holds FILES (paths below ROOT): stokes::embedded_files().
# Text becomes string literals; they have a length limit in some compilers, so a file is cut into pieces of whole
# characters. Compressed files (*.gz) are taken in by the assembler as they are.
set(binaries "")
set(body "    static const std::map<std::string, std::string> files = {\n")
set(count 0)
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name ${ROOT} ${file})
  if(file MATCHES "\\.gz$")
    set(symbol "stokes_embedded_${count}")
    math(EXPR count "${count} + 1")
    string(APPEND binaries
      "__asm__(\".section .rodata\\n\"\n        \".global ${symbol}, ${symbol}_end\\n\"\n"
      "        \"${symbol}:\\n.incbin \\\"${file}\\\"\\n\"\n        \"${symbol}_end:\\n.byte 0\\n.text\\n\");\n"
      "extern \"C\" const char ${symbol}[], ${symbol}_end[];\n\n")
    string(APPEND body "        {\"${name}\", std::string(${symbol}, ${symbol}_end)},\n")
    continue()
  endif()
  file(READ ${file} text)
  string(APPEND body "        {\"${name}\", std::string()")
  string(LENGTH "${text}" length)
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND body "\n             + R\"__stokes(${piece})__stokes\"")
    math(EXPR at "${at} + 8000")
  endwhile()
  string(APPEND body "},\n")
endforeach()
string(APPEND body "    };\n    return files;\n")
file(WRITE ${OUTPUT} "#include \"host/core/embedded.hpp\"\n\n${binaries}namespace stokes {\n\n"
  "const std::map<std::string, std::string>& embedded_files() {\n${body}}\n\n}  // namespace stokes\n")
