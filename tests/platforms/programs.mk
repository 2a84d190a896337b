# What tests/platforms.sh runs, for one platform: make -f tests/platforms/programs.mk OUT=FOLDER CXX=COMPILER FLAGS=...
# THREADS=-pthread LINK=... EXE=.exe FOLDER/lists.exe ... from the repository's root. In two units what takes long to
# compile, the kernels, is the same for many files.

# Left out: what measures time or needs a library more than doctest and GLM.
unit := $(filter-out %/advise.cpp %/matrix.cpp,$(wildcard tests/unit/*.cpp))
one := %/clusters.cpp %/z_bins.cpp %/lights.cpp %/spots.cpp
headers := $(shell find include tests/unit tests/guest tests/platforms tests/split_mix.hpp -name '*.hpp' -o -name '*.inl') tests/platforms/programs.mk
compile = $(CXX) $(level) $(FLAGS) $(THREADS) -Iinclude -I. -isystem $(OUT)/../headers -c -o $@
level = -O1
$(OUT)/lists.o: level = -O2
$(OUT)/lightbin.o $(OUT)/contract.o: level = -O0
link = $(CXX) $(FLAGS) $(THREADS) -o $@ $^ $(LINK)

$(OUT)/%$(EXE): $(OUT)/%.o
	$(link)
$(OUT)/lists$(EXE): $(addprefix $(OUT)/,lists.o garbage.o)
	$(link)
$(OUT)/unit$(EXE): $(addprefix $(OUT)/,doctest_main.o unit_one.o unit_two.o)
	$(link)
$(OUT)/guest$(EXE): $(addprefix $(OUT)/,doctest_main.o allocation.o exceptions.o counted_new.o)
	$(link)
$(OUT)/c$(EXE): $(addprefix $(OUT)/,contract.o lightbin.o)
	$(link)

$(OUT)/unit_one.o: $(filter $(one),$(unit))
$(OUT)/unit_two.o: $(filter-out $(one),$(unit))
$(OUT)/unit_%.o: $(headers)
	printf '#include "%s"\n' $(filter %.cpp,$^) | $(compile) -x c++ -
$(OUT)/%.o: tests/%.cpp
	$(compile) $<
$(OUT)/%.o: tests/platforms/%.cpp $(headers)
	$(compile) $<
$(OUT)/%.o: tests/guest/%.cpp $(headers)
	$(compile) $<
$(OUT)/contract.o: tests/c/contract.c $(headers)
	$(compile) -x c++ $<
# Of the kernels the scalar ones are enough.
$(OUT)/lightbin.o: packaging/lightbin.cpp $(headers)
	$(compile) -DLIGHTBIN_NO_SIMD $<
.SECONDARY:
